#include "warp/camera_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.h"
#include "unit/warp/test_cameras.h"

namespace bole {
namespace {

using ::testing::HasSubstr;

std::string problem_of(const std::filesystem::path& camera_toml) {
  try {
    load_camera(camera_toml);
    return "none";
  } catch (const ConfigError& error) {
    return error.what();
  }
}

const std::vector<std::uint8_t> kAllSeen(320 * 240, 255);

TEST(LoadCamera, ReadsTheExample) {
  const Camera camera = load_camera(BOLE_SOURCE_DIR "/calib/example/camera.toml");
  EXPECT_EQ(camera.model->image_size(), (ImageSize{1280, 960}));
  EXPECT_EQ(camera.mask.size(), 1280u * 960u);
  EXPECT_FALSE(camera.calibration_text.empty());
}

TEST(LoadCamera, PathsAreRelativeToTheFilesOwnFolder) {
  const test::TemporaryFolder folder;
  const auto file = write_small_camera(folder, kAllSeen);
  EXPECT_EQ(load_camera(file).mask, kAllSeen);
}

TEST(LoadCamera, TheDigestChangesWithEachOfTheThreeFiles) {
  const test::TemporaryFolder folder;
  const auto file = write_small_camera(folder, kAllSeen);
  const std::uint32_t before = load_camera(file).digest;
  EXPECT_EQ(load_camera(file).digest, before);
  std::vector<std::uint8_t> mask = kAllSeen;
  mask[1000] = 0;
  write_png(folder.path() / "mask.png", {320, 240}, mask);
  const std::uint32_t other_mask = load_camera(file).digest;
  EXPECT_NE(other_mask, before);
  folder.write("calib.txt", std::string(kSmallOcam) + "# a note\n");
  const std::uint32_t other_calibration = load_camera(file).digest;
  EXPECT_NE(other_calibration, other_mask);
  std::ofstream(file, std::ios::app) << "# a note\n";
  EXPECT_NE(load_camera(file).digest, other_calibration);
}

TEST(LoadCamera, TheDigestTellsCamerasWithoutAMaskApart) {
  const test::TemporaryFolder folder;
  const auto file = write_small_camera(folder);
  const std::uint32_t before = load_camera(file).digest;
  std::ofstream(file, std::ios::app) << "# a note\n";
  EXPECT_NE(load_camera(file).digest, before);
}

TEST(LoadCamera, NamesTheFileThatIsMissing) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(problem_of(folder.path() / "no.toml"), HasSubstr("no.toml"));
  const auto file = write_small_camera(folder, kAllSeen);
  std::filesystem::remove(folder.path() / "mask.png");
  EXPECT_THAT(problem_of(file), HasSubstr("mask.png"));
  std::filesystem::remove(folder.path() / "calib.txt");
  EXPECT_THAT(problem_of(file), HasSubstr("calib.txt"));
}

TEST(LoadCamera, RefusesAMaskOfAnotherSizeOrZeroEverywhere) {
  const test::TemporaryFolder folder;
  const auto file = write_small_camera(folder, kAllSeen);
  write_png(folder.path() / "mask.png", {240, 320}, kAllSeen);
  EXPECT_THAT(problem_of(file), HasSubstr("mask.png: is 240 x 320"));
  write_png(folder.path() / "mask.png", {320, 240}, std::vector<std::uint8_t>(320 * 240, 0));
  EXPECT_THAT(problem_of(file), HasSubstr("zero everywhere"));
}

TEST(LoadCamera, RefusesAMaskThatIsNoPngOrCutShort) {
  const test::TemporaryFolder folder;
  const auto file = write_small_camera(folder, kAllSeen);
  const auto mask = folder.path() / "mask.png";
  std::filesystem::resize_file(mask, std::filesystem::file_size(mask) / 2);
  EXPECT_THAT(problem_of(file), HasSubstr("mask.png: cannot be read as PNG"));
  folder.write("mask.png", "not an image");
  EXPECT_THAT(problem_of(file), HasSubstr("mask.png: cannot be read as PNG"));
  folder.write("mask.png", "");
  EXPECT_THAT(problem_of(file), HasSubstr("mask.png"));
}

}  // namespace
}  // namespace bole
