#include "service/grab_frame.h"

#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/files.h"
#include "capture/frame_source.h"
#include "capture/replay/frame_names.h"
#include "support/temporary_folder.h"

namespace bole {
namespace {

using test::TemporaryFolder;

DaemonConfig config_for(const std::filesystem::path& replayed) {
  return load_daemon_config(
      std::nullopt,
      {{"camera.file", toml_text(BOLE_SOURCE_DIR "/tests/hil/cameras/640x480/camera.toml")},
       {"source.uri", toml_text("replay:" + replayed.string())},
       {"source.pace", toml_text("fast")}});
}

TEST(GrabFrame, WritesTheFrameAsItCameAndNothingThatAReplayTakesForAnother) {
  const TemporaryFolder folder;
  std::string frame(640 * 480 * 2, '\0');
  for (std::size_t i = 0; i < frame.size(); ++i) frame[i] = static_cast<char>(i * i / 977);
  const std::filesystem::path source = folder.write("in.yuyv", frame);
  const DaemonConfig config = config_for(source);

  const GrabbedFrame grabbed = grab_frame(config, folder / "out");

  EXPECT_EQ(grabbed.file, folder / "out.yuyv");
  EXPECT_TRUE(read_text_file(grabbed.file, 1 << 20) == frame);
  std::filesystem::remove(source);
  EXPECT_EQ(frames_in(grabbed.file.parent_path(), {}), std::vector{grabbed.file});
}

TEST(GrabFrame, NamesItFrameInAFolder) {
  const TemporaryFolder folder;
  const DaemonConfig config = config_for(folder.write("in.yuyv", std::string(640 * 480 * 2, 'x')));
  std::filesystem::create_directory(folder / "there");
  EXPECT_EQ(grab_frame(config, folder / "there").file, folder / "there/frame.yuyv");
  EXPECT_EQ(grab_frame(config, folder / "new/").file, folder / "new/frame.yuyv");
}

TEST(GrabFrame, TellsWhyThereIsNone) {
  const TemporaryFolder folder;
  DaemonConfig config = config_for(folder.write("in.yuyv", "short"));
  EXPECT_THROW(grab_frame(config, folder / "out"), ConfigError);
  config.source.uri = "v4l2:/dev/no-such-camera";
  config.source.pace = "realtime";
  EXPECT_THROW(grab_frame(config, folder / "out"), CaptureError);
  EXPECT_FALSE(std::filesystem::exists(folder / "out.yuyv"));
}

}  // namespace
}  // namespace bole
