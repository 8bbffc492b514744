#include "geometry/pinhole.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/angles.h"
#include "support/config_problem.h"

namespace bole {
namespace {

using ::testing::HasSubstr;

constexpr std::string_view kYaml = R"(%YAML:1.0
---
image_width: 640
image_height: 480
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 500., 0., 320.5, 0., 510., 241., 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ -0.28, 0.09, 0.0012, -0.0008, -0.011 ]
)";

std::string problem_of(std::string_view text) {
  return test::config_problem([&] { parse_pinhole(text, "camera.yaml"); });
}

std::string with(const std::string& from, const std::string& to) {
  std::string text(kYaml);
  return text.replace(text.find(from), from.size(), to);
}

TEST(Pinhole, FromAFieldOfViewTheImageSpansIt) {
  const PinholeModel camera = pinhole_from_field_of_view(radians(60), {640, 480});
  const Vec3 left = camera.ray_from_pixel({239.5, -0.5});
  const Vec3 right = camera.ray_from_pixel({239.5, 639.5});
  EXPECT_NEAR(degrees(std::acos(dot(left, right))), 60, 1e-9);
  EXPECT_NEAR(camera.ray_from_pixel({239.5, 319.5}).z, 1, 1e-12);
  EXPECT_LT(left.x, 0);
}

// The point (0.3, -0.2) on the plane z = 1 worked out by hand from OpenCV's formula.
TEST(Pinhole, DistortsAsOpenCvWritesIt) {
  const PinholeModel camera = parse_pinhole(kYaml, "camera.yaml");
  const double r2 = 0.3 * 0.3 + 0.2 * 0.2;
  const double radial = 1 - 0.28 * r2 + 0.09 * r2 * r2 - 0.011 * r2 * r2 * r2;
  const double x = 0.3 * radial + 2 * 0.0012 * 0.3 * -0.2 - 0.0008 * (r2 + 2 * 0.09);
  const double y = -0.2 * radial + 0.0012 * (r2 + 2 * 0.04) + 2 * -0.0008 * 0.3 * -0.2;
  const auto pixel = camera.pixel_from_ray({0.6, -0.4, 2});
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->column, 500 * x + 320.5, 1e-9);
  EXPECT_NEAR(pixel->row, 510 * y + 241, 1e-9);
}

TEST(Pinhole, PixelToRayToPixelComesBack) {
  const PinholeModel camera = parse_pinhole(kYaml, "camera.yaml");
  for (double row = 0; row < 480; row += 13) {
    for (double column = 0; column < 640; column += 17) {
      const auto back = camera.pixel_from_ray(camera.ray_from_pixel({row, column}));
      ASSERT_TRUE(back);
      EXPECT_NEAR(back->row, row, 1e-9);
      EXPECT_NEAR(back->column, column, 1e-9);
    }
  }
}

TEST(Pinhole, WhatLiesBehindOrBeyondTheDistortionsReachIsNotSeen) {
  const PinholeModel camera = parse_pinhole(kYaml, "camera.yaml");
  EXPECT_FALSE(camera.pixel_from_ray({0, 0, -1}));
  EXPECT_FALSE(camera.pixel_from_ray({1, 0, 0}));
  // k1 = -0.28 folds the image back somewhere beyond a slope of one.
  EXPECT_FALSE(camera.pixel_from_ray({30, 0, 1}));
  EXPECT_FALSE(is_ray(camera.ray_from_pixel({241, 320.5 + 500 * 5})));
}

TEST(Pinhole, ACalibrationOfAFisheyeIsRefused) {
  EXPECT_THAT(problem_of(with("camera_matrix", "fisheye_model: 1\ncamera_matrix")),
              HasSubstr("set camera.model = \"fisheye\""));
  EXPECT_THAT(problem_of(with("camera_matrix", "xi: 1.2\ncamera_matrix")), HasSubstr("omnidir"));
  EXPECT_EQ(problem_of(with("camera_matrix", "distortion_model: plumb_bob\ncamera_matrix")),
            "none");
}

TEST(Pinhole, DamagedCalibrationsAreNamed) {
  EXPECT_EQ(problem_of(kYaml), "none");
  EXPECT_THAT(problem_of(""), HasSubstr("camera.yaml"));
  EXPECT_THAT(problem_of("%YAML:1.0"), HasSubstr("camera.yaml"));
  EXPECT_THAT(problem_of("image_width: ["), HasSubstr("camera.yaml"));
  EXPECT_THAT(problem_of("just words"), HasSubstr("camera.yaml"));
  EXPECT_THAT(problem_of(with("image_width: 640\n", "")), HasSubstr("image_width"));
  EXPECT_THAT(problem_of(with("640", "0")), HasSubstr("image_width: is 0"));
  EXPECT_THAT(problem_of(with("640", "1000000")), HasSubstr("image_width"));
  EXPECT_THAT(problem_of(with("500.", "-500.")), HasSubstr("focal length"));
  EXPECT_THAT(problem_of(with("500.", ".nan")), HasSubstr("not finite"));
  EXPECT_THAT(problem_of(with(", 0., 0., 1. ]", " ]")), HasSubstr("camera_matrix"));
  EXPECT_THAT(problem_of(with("-0.28, 0.09, 0.0012, -0.0008, -0.011", "1, 2, 3, 4, 5, 6")),
              HasSubstr("distortion_coefficients"));
  EXPECT_THAT(problem_of(with("-0.28", ".inf")), HasSubstr("not finite"));
}

}  // namespace
}  // namespace bole
