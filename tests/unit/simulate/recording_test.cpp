#include "simulate/recording.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/errors.h"
#include "base/files.h"
#include "support/temporary_folder.h"
#include "test_camera.h"

namespace bole::simulate {
namespace {

namespace fs = std::filesystem;

class Recording : public testing::Test {
 protected:
  Recording() : folder_(temporary_.path()) {
    // The camera's own files, as load_camera would have read them.
    camera_ = test_camera(160, "height_m = 1\n");
    camera_.mask.clear();
    camera_.file = folder_ / "camera" / "camera.toml";
    write(folder_ / "camera" / "calib_results.txt", camera_.calibration_text);
  }
  static void write(const fs::path& path, const std::string& text) {
    write_file_atomically(path, std::as_bytes(std::span(text)));
  }
  static std::string read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }
  void make(const char* name, const char* format, int frames) {
    RecordingOptions options;
    options.frames = frames;
    options.format = format;
    record(folder_ / name, camera_, options, [this](int done) { progress_.push_back(done); });
  }

  test::TemporaryFolder temporary_;
  fs::path folder_;
  Camera camera_;
  std::vector<int> progress_;
};

TEST_F(Recording, IsAWholeReplay) {
  make("a", "yuyv", 3);
  EXPECT_EQ(progress_, (std::vector{1, 2, 3}));
  const Camera camera = load_camera(folder_ / "a" / "camera.toml");
  EXPECT_EQ(camera.model->image_size(), (ImageSize{160, 120}));
  EXPECT_EQ(read(folder_ / "a" / "timestamps.csv"),
            "frame_000000.yuyv,0\nframe_000001.yuyv,100000\nframe_000002.yuyv,200000\n");
  EXPECT_EQ(fs::file_size(folder_ / "a" / "frame_000002.yuyv"), 160U * 120 * 2);
  const auto truth = nlohmann::json::parse(read(folder_ / "a" / "truth.json"));
  EXPECT_TRUE(truth.at("metric").get<bool>());
  EXPECT_EQ(truth.at("height_m"), 1);
  ASSERT_EQ(truth.at("frames").size(), 3U);
  EXPECT_EQ(truth.at("frames")[1].at("file"), "frame_000001.yuyv");
  for (const char* key : {"range", "bearing", "diameter", "visible", "id"}) {
    EXPECT_TRUE(truth.at("frames")[0].at("trees")[0].contains(key)) << key;
  }
}

TEST_F(Recording, IsTheSameEveryTime) {
  make("a", "png", 5);
  make("b", "png", 5);
  for (const auto& entry : fs::directory_iterator(folder_ / "a")) {
    EXPECT_EQ(read(entry.path()), read(folder_ / "b" / entry.path().filename())) << entry.path();
  }
}

TEST_F(Recording, FormatsThatAreNotKnownAreRefused) {
  EXPECT_THROW(make("a", "tiff", 1), ConfigError);
}

}  // namespace
}  // namespace bole::simulate
