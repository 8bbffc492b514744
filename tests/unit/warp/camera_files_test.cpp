#include "warp/camera_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "base/files.h"
#include "geometry/angles.h"
#include "support/config_problem.h"
#include "unit/warp/test_cameras.h"
#include "warp/warp_table.h"

namespace bole {
namespace {

using ::testing::HasSubstr;

std::string problem_of(const std::filesystem::path& camera_toml) {
  return test::config_problem([&] { load_camera(camera_toml); });
}

const std::vector<std::uint8_t> kAllSeen(320 * 240, 255);

TEST(LoadCamera, ReadsTheExample) {
  const Camera camera = load_camera(BOLE_SOURCE_DIR "/calib/example/camera.toml");
  EXPECT_EQ(camera.model->image_size(), (ImageSize{1280, 960}));
  EXPECT_EQ(camera.mask.size(), 1280u * 960u);
  EXPECT_FALSE(camera.calibration_text.empty());
}

TEST(LoadCamera, ReadsEveryExample) {
  std::map<std::string, Camera> cameras;
  for (const auto& folder : std::filesystem::directory_iterator(BOLE_SOURCE_DIR "/calib")) {
    cameras[folder.path().filename()] = load_camera(folder.path() / "camera.toml");
  }
  ASSERT_EQ(cameras.size(), 3u);
  EXPECT_EQ(cameras.at("fisheye").config.model, CameraConfig::Model::fisheye);
  // As the pinhole's file says of its horizon_row.
  EXPECT_NEAR(cameras.at("pinhole").config.mount.pitch, radians(4.1), radians(0.05));
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

// The small camera with a parabolic mirror, which both models describe exactly: f(rho) =
// -50 + rho^2 / 200.
TEST(LoadCamera, TheSameCameraAsOcamAndAsOmnidirFillsTheSamePanorama) {
  const test::TemporaryFolder folder;
  const auto file = write_small_camera(folder);
  folder.write("calib.txt", "3 -50 0 5e-3\n2 75.5 62.5\n120.8 159.1\n1 0 0\n240 320\n");
  folder.write("calib.yml",
               "%YAML:1.0\n---\ncamera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
               "   data: [ 100., 0., 159.1, 0., 100., 120.8, 0., 0., 1. ]\n"
               "distortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 4\n   dt: d\n"
               "   data: [ 0., 0., 0., 0. ]\nxi: 1.\n");
  const std::string toml = read_text_file(file, 1 << 16);
  const std::string ocam = "model = \"ocam\"\ncalibration = \"calib.txt\"";
  for (const char* const sides :
       {"left = \"image right\"", "left = \"image left\"",
        "left = \"image up\"\nforward = \"image right\"\ncentre = \"up\""}) {
    std::string text = toml;
    text.replace(text.find("left ="), sizeof("left = \"image right\"") - 1, sides);
    const Camera first = load_camera(folder.write("camera.toml", text));
    text.replace(text.find(ocam), ocam.size(),
                 "model = \"omnidir\"\ncalibration = \"calib.yml\"\nwidth = 320\nheight = 240");
    const Camera second = load_camera(folder.write("camera.toml", text));
    EXPECT_NE(first.digest, second.digest);
    const WarpTable a = build_warp_table(first), b = build_warp_table(second);
    EXPECT_EQ(a.panorama(), b.panorama());
    ASSERT_EQ(a.entries().size(), b.entries().size());
    // The last bit of a rounded place may differ.
    std::size_t seen = 0, apart = 0;
    for (std::size_t i = 0; i < a.seen().pixels.size(); ++i) {
      seen += a.seen().pixels[i] != 0 ? 1 : 0;
      apart += a.seen().pixels[i] != b.seen().pixels[i] ? 1 : 0;
    }
    for (std::size_t i = 0; i < a.entries().size(); ++i) {
      apart += a.entries()[i] != b.entries()[i] ? 1 : 0;
    }
    EXPECT_GT(seen, 10000u);
    EXPECT_LT(apart, 20u);
  }
}

TEST(LoadCamera, RefusesAHorizonThatNoRayLeadsTo) {
  const test::TemporaryFolder folder;
  folder.write("calib.yml",
               "camera_matrix: {data: [100, 0, 80, 0, 100, 60, 0, 0, 1]}\n"
               "distortion_coefficients: {data: [-0.3, 0, 0, 0]}\n");
  const auto file = folder.write("camera.toml",
                                 "[camera]\nmodel = \"pinhole\"\ncalibration = \"calib.yml\"\n"
                                 "width = 160\nheight = 120\n[mount]\nheight_m = 1\n"
                                 "horizon_row = 900\n[panorama]\nrange_min_m = 2\n");
  EXPECT_THAT(problem_of(file), HasSubstr("camera.toml: mount.horizon_row"));
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
