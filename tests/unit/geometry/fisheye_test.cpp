#include "geometry/fisheye.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "geometry/angles.h"
#include "geometry/mount.h"
#include "geometry/ocam.h"
#include "support/config_problem.h"
#include "unit/geometry/opencv_yaml.h"
#include "unit/geometry/same_world.h"

namespace bole {
namespace {

using ::testing::HasSubstr;

FisheyeModel read(std::string_view text, ImageSize size = {}) {
  return parse_fisheye(text, "fisheye.yml", size);
}

std::string problem_of(std::string_view text, ImageSize size = {}) {
  return test::config_problem([&] { read(text, size); });
}

std::string with(std::string_view from, std::string_view to) {
  return replaced(kFisheyeYaml, from, to);
}

// 1280 x 960, with the principal point off the middle and its own focal length each way.
FisheyeModel equidistant() {
  return FisheyeModel(
      {.matrix = {.focal_x = 300, .focal_y = 300, .centre_column = 650, .centre_row = 470},
       .distortion = {},
       .size = {1280, 960}});
}

// OpenCV 5.0's own numbers, which end at a right angle:
//   cv2.fisheye.projectPoints(rays.reshape(-1, 1, 3), np.zeros(3), np.zeros(3),
//       np.array([[420.5, 0, 641.3], [0, 418.2, 478.9], [0, 0, 1]]),
//       np.array([0.035, -0.012, 0.0041, -0.0009]), alpha=0.002)
// where cv2.fisheye.calibrate writes alpha times 420.5 into the matrix.
TEST(Fisheye, FallsWhereOpenCvSays) {
  struct Golden {
    Vec3 ray;
    double column, row;
  };
  constexpr std::array<Golden, 5> kGolden = {{{{0.1, 0.2, 1}, 682.904150989, 561.323485338},
                                              {{-1.5, 0.4, 1}, 225.207259712, 589.310044446},
                                              {{0, -3, 0.5}, 640.070308939, -132.582522710},
                                              {{2, 2, 0.3}, 1095.828946575, 930.040538086},
                                              {{1e-3, 0, 1}, 641.720499875, 478.9}}};
  const FisheyeModel camera = read(kFisheyeYaml);
  for (const Golden& golden : kGolden) {
    const auto pixel = camera.pixel_from_ray(golden.ray);
    ASSERT_TRUE(pixel);
    EXPECT_NEAR(pixel->column, golden.column, 1e-8);
    EXPECT_NEAR(pixel->row, golden.row, 1e-8);
    const Vec3 ray = normalized(golden.ray), back = camera.ray_from_pixel(*pixel);
    EXPECT_NEAR(norm(back), 1, 1e-12);
    EXPECT_NEAR(dot(ray, back), 1, 1e-12);
  }
}

TEST(Fisheye, PixelToRayToPixelComesBackBeyondARightAngleToo) {
  const FisheyeModel camera = read(kFisheyeYaml);
  double lowest = 1;
  int seen = 0;
  for (double row = -300; row < 1300; row += 7) {
    for (double column = -200; column < 1500; column += 11) {
      const Vec3 ray = camera.ray_from_pixel({row, column});
      if (!is_ray(ray)) continue;
      const auto back = camera.pixel_from_ray(ray);
      ASSERT_TRUE(back) << row << " " << column;
      ASSERT_NEAR(back->row, row, 1e-8);
      ASSERT_NEAR(back->column, column, 1e-8);
      lowest = std::min(lowest, ray.z);
      ++seen;
    }
  }
  EXPECT_GT(seen, 25000);
  EXPECT_LT(lowest, -0.4);
}

TEST(Fisheye, TheMiddleSeesAlongTheAxisAndNothingIsSeenStraightBehind) {
  const FisheyeModel camera = equidistant();
  const auto middle = camera.pixel_from_ray({0, 0, 2});
  ASSERT_TRUE(middle);
  EXPECT_EQ(middle->row, 470);
  EXPECT_EQ(middle->column, 650);
  EXPECT_EQ(camera.ray_from_pixel({470, 650}), (Vec3{0, 0, 1}));
  EXPECT_FALSE(camera.pixel_from_ray({0, 0, -1}));
  EXPECT_TRUE(camera.pixel_from_ray({0.1, 0, -1}));
  EXPECT_FALSE(is_ray(camera.ray_from_pixel({470, 650 + 300 * kPi})));
  EXPECT_FALSE(camera.pixel_from_ray(kNoRay));
  EXPECT_FALSE(camera.pixel_from_ray({0, std::numeric_limits<double>::quiet_NaN(), 1}));
}

// theta (1 - 0.2 theta^2) turns at the square root of 1 / 0.6, where it is 2/3 of that.
TEST(Fisheye, WhereTheDistortionTurnsTheImageEnds) {
  const double last = std::sqrt(1 / 0.6);
  const FisheyeModel camera(
      {.matrix = {.focal_x = 300, .focal_y = 300, .centre_column = 650, .centre_row = 470},
       .distortion = {-0.2, 0, 0, 0},
       .size = {1280, 960}});
  const auto ray = [](double angle) { return Vec3{std::sin(angle), 0, std::cos(angle)}; };
  EXPECT_TRUE(camera.pixel_from_ray(ray(last - 0.002)));
  EXPECT_FALSE(camera.pixel_from_ray(ray(last + 0.002)));
  EXPECT_TRUE(is_ray(camera.ray_from_pixel({470, 650 + 300 * (last * 2 / 3 - 0.001)})));
  EXPECT_FALSE(is_ray(camera.ray_from_pixel({470, 650 + 300 * (last * 2 / 3 + 0.001)})));
}

// rho = F theta is f(rho) = -rho cot(rho / F) in OCamCalib's form, whose series in x = rho / F is
// -F (1 - 2 sum zeta(2n) (x / pi)^(2n)).
OcamModel equidistant_ocam() {
  OcamModel::Parameters p{.direct = std::vector<double>(19, 0.0),
                          .inverse = {0},
                          .centre_row = 470,
                          .centre_column = 650,
                          .size = {1280, 960}};
  p.direct[0] = -300;
  for (std::size_t n = 2; n < p.direct.size(); n += 2) {
    double zeta = 0;
    for (int k = 1; k < 100000; ++k) zeta += std::pow(k, -static_cast<double>(n));
    p.direct[n] = 2 * 300 * zeta / std::pow(300 * kPi, n);
  }
  return OcamModel(p);
}

TEST(Fisheye, SeesTheWorldAsTheSameCameraDoesInOcamCalibsForm) {
  for (const ImageSide left : {ImageSide::left, ImageSide::right}) {
    // The series is cut off: at 100 degrees it is good to 1e-5.
    expect_same_world(equidistant(), equidistant_ocam(), ImageSide::down, left, 300 * radians(100),
                      2e-5);
  }
}

TEST(Fisheye, RosCallsItEquidistant) {
  const std::string ros = with("fisheye_model: 1", "distortion_model: equidistant");
  EXPECT_EQ(read(ros).image_size(), (ImageSize{1280, 960}));
  EXPECT_EQ(problem_of(with("fisheye_model: 1\n", "")), "none");
}

TEST(Fisheye, ACalibrationOfAnotherModelIsRefused) {
  EXPECT_THAT(problem_of(with("fisheye_model: 1", "fisheye_model: 0")),
              HasSubstr("fisheye.yml: fisheye_model: is of a camera of the model pinhole; set "
                        "camera.model = \"pinhole\""));
  EXPECT_THAT(problem_of(with("fisheye_model: 1", "distortion_model: plumb_bob")),
              HasSubstr("distortion_model"));
  EXPECT_THAT(problem_of(with("fisheye_model: 1", "xi: 1.2")), HasSubstr("omnidir"));
}

TEST(Fisheye, DamagedCalibrationsAreNamedByFileAndKey) {
  EXPECT_EQ(problem_of(kFisheyeYaml), "none");
  EXPECT_THAT(problem_of("<?xml version=\"1.0\"?>"), HasSubstr("fisheye.yml: is XML"));
  EXPECT_THAT(problem_of("xi"), HasSubstr("fisheye.yml"));
  EXPECT_THAT(problem_of(with("camera_matrix", "K")),
              HasSubstr("fisheye.yml: camera_matrix: is missing"));
  EXPECT_THAT(problem_of(with("distortion_coefficients", "D")),
              HasSubstr("distortion_coefficients: is missing"));
  EXPECT_THAT(problem_of(with(", -0.0009", "")),
              HasSubstr("distortion_coefficients: has 3 numbers; needs 4"));
  EXPECT_THAT(problem_of(with("-0.0009", "-0.0009, 1")), HasSubstr("distortion_coefficients"));
  EXPECT_THAT(problem_of(with("0.035", ".nan")), HasSubstr("distortion_coefficients: a number"));
  EXPECT_THAT(problem_of(with("0.035", "oak")),
              HasSubstr("distortion_coefficients: cannot be read"));
  EXPECT_THAT(problem_of(with("image_width: 1280", "image_width: wide")),
              HasSubstr("fisheye.yml: image_width: cannot be read"));
  EXPECT_THAT(problem_of(with("0.035", "1e300")), HasSubstr("distortion_coefficients: a number"));
  EXPECT_THAT(problem_of(with("420.5", "0.")), HasSubstr("camera_matrix: a focal length"));
  EXPECT_THAT(problem_of(with("420.5", ".Inf")), HasSubstr("camera_matrix: a number"));
  EXPECT_THAT(problem_of(with("641.3", "1e200")), HasSubstr("camera_matrix: a number"));
  EXPECT_THAT(problem_of(with("0., 0., 1. ]", "0., 0., 0. ]")), HasSubstr("no camera matrix"));
  EXPECT_THAT(problem_of(with("1280", "-1280")), HasSubstr("image_width: is -1280"));
}

TEST(Fisheye, TheImagesSizeMayStandInCameraToml) {
  const std::string without = with("image_width: 1280\nimage_height: 960\n", "");
  EXPECT_THAT(problem_of(without), HasSubstr("image_width: is missing; give width and height"));
  EXPECT_EQ(read(without, {1280, 960}).image_size(), (ImageSize{1280, 960}));
  EXPECT_EQ(problem_of(kFisheyeYaml, {1280, 960}), "none");
  EXPECT_THAT(problem_of(kFisheyeYaml, {640, 480}), HasSubstr("is of 1280 x 960 pixels"));
}

TEST(Fisheye, ParametersWithoutMeaningAreRefused) {
  EXPECT_THROW(FisheyeModel({}), std::invalid_argument);
}

}  // namespace
}  // namespace bole
