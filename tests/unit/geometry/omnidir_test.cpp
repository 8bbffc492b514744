#include "geometry/omnidir.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "geometry/mount.h"
#include "geometry/ocam.h"
#include "geometry/pinhole.h"
#include "support/config_problem.h"
#include "unit/geometry/opencv_yaml.h"
#include "unit/geometry/same_world.h"

namespace bole {
namespace {

using ::testing::HasSubstr;

OmnidirModel read(std::string_view text, ImageSize size = {}) {
  return parse_omnidir(text, "omnidir.yml", size);
}

std::string problem_of(std::string_view text) {
  return test::config_problem([&] { read(text); });
}

std::string with(std::string_view from, std::string_view to) {
  return replaced(kOmnidirYaml, from, to);
}

OmnidirModel without_distortion(double xi) {
  return OmnidirModel(
      {.matrix = {.focal_x = 300, .focal_y = 300, .centre_column = 650, .centre_row = 470},
       .xi = xi,
       .distortion = {},
       .size = {1280, 960}});
}

struct Golden {
  Vec3 ray;
  double column, row;
};

void expect_golden(const OmnidirModel& camera, const std::array<Golden, 5>& all) {
  for (const Golden& golden : all) {
    const auto pixel = camera.pixel_from_ray(golden.ray);
    ASSERT_TRUE(pixel);
    EXPECT_NEAR(pixel->column, golden.column, 1e-8);
    EXPECT_NEAR(pixel->row, golden.row, 1e-8);
    const Vec3 ray = normalized(golden.ray), back = camera.ray_from_pixel(*pixel);
    EXPECT_NEAR(norm(back), 1, 1e-12);
    EXPECT_NEAR(dot(ray, back), 1, 1e-12);
  }
}

// The numbers of opencv-contrib 4.10:
//   cv2.omnidir.projectPoints(rays.reshape(-1, 1, 3), np.zeros((1, 3)), np.zeros((1, 3)),
//       np.array([[760.4, 0.8, 641.3], [0, 758.9, 478.9], [0, 0, 1]]), xi,
//       np.array([[-0.31, 0.12, 0.0011, -0.0007]]))
TEST(Omnidir, FallsWhereOpenCvSays) {
  expect_golden(read(kOmnidirYaml), {{{{0.1, 0.2, 1}, 673.184361968, 542.425962561},
                                      {{-1.5, 0.4, 1}, 332.925006500, 561.131099262},
                                      {{0, -3, 0.5}, 640.611502119, 39.991160028},
                                      {{2, 2, -0.9}, 1045.601702944, 883.110928656},
                                      {{1e-3, 0, 1}, 641.623574068, 478.900000151}}});
  expect_golden(read(with("xi: 1.35", "xi: 0.9")),
                {{{{0.1, 0.2, 1}, 680.775123612, 557.554678193},
                  {{-1.5, 0.4, 1}, 251.495644401, 582.907693322},
                  {{0, -3, 0.5}, 640.235532908, -97.242841478},
                  {{2, 2, -0.9}, 1491.325094690, 1329.835931382},
                  {{1e-3, 0, 1}, 641.700209955, 478.900000231}}});
}

TEST(Omnidir, PixelToRayToPixelComesBackAndTheRestSeesNothing) {
  for (const char* xi : {"xi: 0.3", "xi: 1.0", "xi: 1.35", "xi: 2.5"}) {
    const OmnidirModel camera = read(with("xi: 1.35", xi));
    int seen = 0;
    for (double row = 0; row < 960; row += 7) {
      for (double column = 0; column < 1280; column += 11) {
        const Vec3 ray = camera.ray_from_pixel({row, column});
        if (!is_ray(ray)) continue;
        const auto back = camera.pixel_from_ray(ray);
        ASSERT_TRUE(back) << xi << " " << row << " " << column;
        ASSERT_NEAR(back->row, row, 1e-7) << xi << " " << column;
        ASSERT_NEAR(back->column, column, 1e-7) << xi << " " << row;
        ++seen;
      }
    }
    EXPECT_GT(seen, 3000) << xi;
  }
}

TEST(Omnidir, WithXiZeroItIsAPinhole) {
  const PinholeModel pinhole(
      {.matrix = {.focal_x = 300, .focal_y = 300, .centre_column = 650, .centre_row = 470},
       .distortion = {},
       .size = {1280, 960}});
  const OmnidirModel camera = without_distortion(0);
  for (const Vec3& ray : {Vec3{0.1, -0.4, 1}, Vec3{-2, 0.4, 0.5}}) {
    EXPECT_NEAR(camera.pixel_from_ray(ray)->row, pinhole.pixel_from_ray(ray)->row, 1e-9);
    EXPECT_NEAR(camera.pixel_from_ray(ray)->column, pinhole.pixel_from_ray(ray)->column, 1e-9);
  }
  EXPECT_FALSE(camera.pixel_from_ray({1, 0, 0}));
  EXPECT_FALSE(camera.pixel_from_ray({1, 0, -0.1}));
}

// Seen from xi behind it, the sphere ends where the line of sight touches it: at cos = -1 / xi,
// 1 / sqrt(xi^2 - 1) from the principal point.
TEST(Omnidir, BeyondTheSpheresRimNothingIsSeen) {
  const OmnidirModel camera = without_distortion(2);
  const auto ray = [](double z) { return Vec3{std::sqrt(1 - z * z), 0, z}; };
  EXPECT_TRUE(camera.pixel_from_ray(ray(-0.499)));
  EXPECT_FALSE(camera.pixel_from_ray(ray(-0.501)));
  EXPECT_TRUE(is_ray(camera.ray_from_pixel({470, 650 + 300 * (1 / std::sqrt(3) - 1e-3)})));
  EXPECT_FALSE(is_ray(camera.ray_from_pixel({470, 650 + 300 * (1 / std::sqrt(3) + 1e-3)})));
  EXPECT_FALSE(camera.pixel_from_ray({0, 0, -1}));
  EXPECT_FALSE(camera.pixel_from_ray(kNoRay));
  EXPECT_EQ(camera.ray_from_pixel({470, 650}), (Vec3{0, 0, 1}));
}

// A parabolic mirror, xi = 1, is f(rho) = -F / 2 + rho^2 / (2 F) in OCamCalib's form, exactly.
TEST(Omnidir, SeesTheWorldAsTheSameMirrorDoesInOcamCalibsForm) {
  const OcamModel ocam({.direct = {-150, 0, 1 / 600.0},
                        .inverse = {0},
                        .centre_row = 470,
                        .centre_column = 650,
                        .size = {1280, 960}});
  for (const ImageSide left : {ImageSide::up, ImageSide::down}) {
    expect_same_world(without_distortion(1), ocam, ImageSide::right, left, kWholeImage, 1e-12);
  }
}

TEST(Omnidir, OpenCvsSampleWritesNoImageSizeAndXiMayBeAMatrix) {
  const std::string sample = with("image_width: 1280\nimage_height: 960\n", "");
  EXPECT_EQ(read(sample, {1280, 960}).image_size(), (ImageSize{1280, 960}));
  EXPECT_EQ(problem_of(with("xi: 1.35",
                            "xi: !!opencv-matrix\n   rows: 1\n   cols: 1\n   dt: d\n"
                            "   data: [ 1.35 ]")),
            "none");
}

TEST(Omnidir, DamagedCalibrationsAreNamedByFileAndKey) {
  EXPECT_EQ(problem_of(kOmnidirYaml), "none");
  EXPECT_THAT(problem_of(with("xi: 1.35", "")), HasSubstr("omnidir.yml: xi: is missing"));
  EXPECT_THAT(problem_of(with("xi: 1.35", "fisheye_model: 1")), HasSubstr("fisheye_model"));
  EXPECT_THAT(problem_of(with("1.35", "-0.2")), HasSubstr("xi: is negative"));
  EXPECT_THAT(problem_of(with("1.35", ".nan")), HasSubstr("xi: is negative, huge or not finite"));
  EXPECT_THAT(problem_of(with("1.35", "1e300")), HasSubstr("xi"));
  EXPECT_THAT(problem_of(with("1.35", "wide")), HasSubstr("omnidir.yml: xi: cannot be read"));
  EXPECT_THAT(problem_of(with("-0.0007", "-0.0007, 0.1")),
              HasSubstr("distortion_coefficients: has 5 numbers; needs 4"));
  EXPECT_THAT(problem_of(with("760.4", "-760.4")), HasSubstr("camera_matrix: a focal length"));
}

}  // namespace
}  // namespace bole
