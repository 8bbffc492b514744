#include "service/grab_frame.h"

#include <gtest/gtest.h>

#include "base/errors.h"
#include "base/files.h"
#include "capture/frame_source.h"
#include "support/temporary_folder.h"
#include "warp/warper.h"

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

TEST(GrabFrame, WritesTheFrameAsItCameAndUnwarped) {
  const TemporaryFolder folder;
  std::string frame(640 * 480 * 2, '\0');
  for (std::size_t i = 0; i < frame.size(); ++i) frame[i] = static_cast<char>(i * i / 977);
  const std::filesystem::path source = folder.write("in.yuyv", frame);
  const DaemonConfig config = config_for(source);

  const GrabbedFrame grabbed = grab_frame(config, folder / "out");

  EXPECT_EQ(grabbed.raw, folder / "out.yuyv");
  EXPECT_TRUE(read_text_file(grabbed.raw, 1 << 20) == frame);

  const Camera camera = load_camera(config.camera.file);
  const WarpTable table = build_warp_table(camera);
  Warper warper(table);
  const auto bytes = std::as_bytes(std::span(frame));
  const PanoramaView panorama =
      warper.warp(view_packed(PixelFormat::yuyv, {640, 480}, bytes).value());
  const std::string written = read_text_file(grabbed.panorama, 1 << 22);
  const auto width = static_cast<std::size_t>(panorama.geometry->width);
  const auto rows = static_cast<std::size_t>(panorama.geometry->rows);
  const std::string header =
      "P5\n" + std::to_string(width) + " " + std::to_string(rows) + "\n255\n";
  ASSERT_EQ(written.size(), header.size() + width * rows);
  EXPECT_EQ(written.substr(0, header.size()), header);
  const std::string last_row(
      reinterpret_cast<const char*>(panorama.row(panorama.geometry->rows - 1)), width);
  EXPECT_TRUE(written.substr(written.size() - width) == last_row);
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
