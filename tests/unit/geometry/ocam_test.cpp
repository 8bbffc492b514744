#include "geometry/ocam.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "support/config_problem.h"

namespace bole {
namespace {

using ::testing::HasSubstr;

const std::filesystem::path kReference =
    std::filesystem::path(BOLE_SHARED_DIR) / "data" / "ocam_reference";
constexpr std::string_view kText =
    "# direct\n4 -182.6 0 2.03e-3 -1.9e-7\n# inverse\n2 302 250\n# centre\n483.2 636.4\n"
    "0.9998 0.0002 -0.0002\n# size\n960 1280\n";

OcamModel model_of(std::string_view text) { return parse_ocam(text, "calib_results.txt"); }

std::string problem_of(const std::string& text) {
  return test::config_problem([&] { model_of(text); });
}

std::string with(const std::string& from, const std::string& to) {
  std::string text(kText);
  return text.replace(text.find(from), from.size(), to);
}

class OcamReference : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kReference)) GTEST_SKIP() << kReference << " is not there";
  }
  OcamModel model() const {
    return parse_ocam(read_text_file(kReference / GetParam(), 1 << 20), GetParam());
  }
};

TEST_P(OcamReference, RaysAgreeWithAnIndependentImplementation) {
  const OcamModel camera = model();
  const auto json = nlohmann::json::parse(std::ifstream(kReference / "pixel_rays.json"));
  const auto& pairs = json.at("tables").at(GetParam());
  ASSERT_EQ(pairs.size(), 200u);
  for (const auto& pair : pairs) {
    const Vec3 ray = camera.ray_from_pixel({pair[0], pair[1]});
    EXPECT_NEAR(ray.x, pair[2].get<double>(), 1e-9);
    EXPECT_NEAR(ray.y, pair[3].get<double>(), 1e-9);
    EXPECT_NEAR(ray.z, pair[4].get<double>(), 1e-9);
  }
}

TEST_P(OcamReference, PixelToRayToPixelComesBack) {
  const OcamModel camera = model();
  const OcamModel::Parameters& p = camera.parameters();
  int seen = 0;
  for (int row = 0; row < p.size.height; row += 3) {
    for (int column = 0; column < p.size.width; column += 3) {
      const Pixel pixel{double(row), double(column)};
      if (std::hypot(row - p.centre_row, column - p.centre_column) > camera.largest_radius() - 1) {
        continue;
      }
      const auto back = camera.pixel_from_ray(camera.ray_from_pixel(pixel));
      ASSERT_TRUE(back) << row << " " << column;
      ASSERT_NEAR(back->row, row, 1e-6);
      ASSERT_NEAR(back->column, column, 1e-6);
      ++seen;
    }
  }
  EXPECT_GT(seen, 30000);
}

TEST_P(OcamReference, TheFilesOwnInverseIsCloseToTheSolvedOne) {
  const OcamModel camera = model();
  const OcamModel::Parameters& p = camera.parameters();
  for (double radius = 20; radius < p.size.height / 2.0 - 20; radius += 7) {
    const Vec3 ray = camera.ray_from_pixel({p.centre_row + radius, p.centre_column});
    const auto fit = camera.pixel_from_ray_by_fit(ray);
    const auto solved = camera.pixel_from_ray(ray);
    ASSERT_TRUE(fit && solved);
    EXPECT_NEAR(fit->row, solved->row, 0.5);
  }
}

INSTANTIATE_TEST_SUITE_P(BothCalibrations, OcamReference,
                         ::testing::Values("calib_results_catadioptric.txt",
                                           "calib_results_fisheye.txt"));

TEST(Ocam, ReadsNumbersInTheOrderOfTheFile) {
  const OcamModel::Parameters p = model_of(kText).parameters();
  EXPECT_EQ(p.direct, (std::vector{-182.6, 0.0, 2.03e-3, -1.9e-7}));
  EXPECT_EQ(p.inverse, (std::vector{302.0, 250.0}));
  EXPECT_EQ(p.centre_row, 483.2);
  EXPECT_EQ(p.centre_column, 636.4);
  EXPECT_EQ(p.size, (ImageSize{1280, 960}));
}

TEST(Ocam, TheMiddleSeesAlongTheAxisAndNothingIsSeenTheOtherWay) {
  const OcamModel camera = model_of(kText);
  const auto middle = camera.pixel_from_ray({0, 0, -3});
  ASSERT_TRUE(middle);
  EXPECT_NEAR(middle->row, 483.2, 1e-12);
  EXPECT_NEAR(middle->column, 636.4, 1e-12);
  EXPECT_FALSE(camera.pixel_from_ray({0, 0, 1}));
  EXPECT_FALSE(camera.pixel_from_ray({1, 0, 1e6}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(camera.pixel_from_ray({nan, 0, 1}));
  EXPECT_FALSE(camera.pixel_from_ray({1, 0, nan}));
}

TEST(Ocam, AxesPointDownTheRowsAndAlongTheColumns) {
  const OcamModel camera = model_of(kText);
  EXPECT_GT(camera.pixel_from_ray({1, 0, 0})->row, 483.2 + 100);
  EXPECT_GT(camera.pixel_from_ray({0, 1, 0})->column, 636.4 + 100);
}

TEST(Ocam, BeyondTheRadiusWhereThePolynomialTurnsThereIsNoImage) {
  // f(rho) / rho stops growing at about 280 pixels.
  const OcamModel camera = model_of("4 -182.6 0 2.03e-3 -2.9e-6\n1 0\n480 640\n1 0 0\n960 1280\n");
  EXPECT_LT(camera.largest_radius(), 500);
  for (double radius = 1; radius < camera.largest_radius() - 1; radius += 0.7) {
    const auto back = camera.pixel_from_ray(camera.ray_from_pixel({480 + radius, 640}));
    ASSERT_TRUE(back);
    EXPECT_NEAR(back->row, 480 + radius, 0.01);
  }
}

TEST(Ocam, DamagedCalibrationsAreNamed) {
  EXPECT_EQ(problem_of(std::string(kText)), "none");
  EXPECT_THAT(problem_of(""), HasSubstr("calib_results.txt: direct polynomial: is missing"));
  EXPECT_THAT(problem_of(with("960 1280", "960")), HasSubstr("image width: is missing"));
  EXPECT_THAT(problem_of(with("4 -182.6", "40 -182.6")), HasSubstr("direct polynomial"));
  EXPECT_THAT(problem_of(with("-182.6", "nan")), HasSubstr("not a finite number"));
  EXPECT_THAT(problem_of(with("483.2", "inf")), HasSubstr("centre row"));
  EXPECT_THAT(problem_of(with("483.2", "1e999")), HasSubstr("centre row"));
  EXPECT_THAT(problem_of(with("483.2", "48x3")), HasSubstr("48x3"));
  EXPECT_THAT(problem_of(with("4 -182.6 0 2.03e-3 -1.9e-7", "4 0 0 0 0")),
              HasSubstr("first coefficient is not negative"));
  EXPECT_THAT(problem_of(with("4 -182.6", "4 182.6")), HasSubstr("not negative"));
  EXPECT_THAT(problem_of(with("0.9998 0.0002 -0.0002", "0 0 0")), HasSubstr("singular"));
  EXPECT_THAT(problem_of(with("483.2", "1e15")), HasSubstr("centre lies outside"));
  EXPECT_THAT(problem_of(with("960 1280", "0 1280")), HasSubstr("image height"));
  EXPECT_THAT(problem_of(with("960 1280", "960 1e9")), HasSubstr("image width"));
  EXPECT_THAT(problem_of(with("960 1280", "960.5 1280")), HasSubstr("image height"));
}

}  // namespace
}  // namespace bole
