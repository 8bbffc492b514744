#include "evaluate/camera_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include <nlohmann/json.hpp>

#include "geometry/angles.h"
#include "unit/warp/test_cameras.h"

namespace bole {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// The small camera with some of its lines replaced, checked.
CameraCheck check_with(const std::vector<std::pair<std::string, std::string>>& changes,
                       const std::vector<std::uint8_t>& mask = {}) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = write_small_camera(folder, mask);
  std::string text = read_text_file(file, 1 << 16);
  for (const auto& [from, to] : changes) text.replace(text.find(from), from.size(), to);
  const Camera camera = load_camera(folder.write("camera.toml", text));
  return check_camera(camera, build_warp_table(camera));
}

TEST(CameraCheck, TellsWhatACameraAmountsTo) {
  const CameraCheck check = check_with({});
  EXPECT_EQ(check.model, "ocam");
  EXPECT_EQ(check.image.width, 320);
  EXPECT_EQ(check.masked, 0);
  EXPECT_LT(check.there_and_back.most_px, 1e-9);
  EXPECT_EQ(check.columns_a_degree, 1);
  EXPECT_NEAR(check.pixels_a_degree, 1.3, 0.3);
  // One row is 2 pi / 360 of tangent, which is range^2 / height of range.
  EXPECT_NEAR(check.row_worth.at(1).metres, 16 / 1.05 * 2 * kPi / 360, 1e-9);
  EXPECT_NEAR(check.narrowest_trunk, 0.2 / 8 * 360 / (2 * kPi), 1e-3);
  ASSERT_TRUE(check.nearest_ground);
  EXPECT_NEAR(check.nearest_ground->median, 0.9, 0.05);
  EXPECT_THAT(check.blind, IsEmpty());
}

TEST(CameraCheck, NamesTheBearingsThatSeeNothing) {
  // The robot's forward lies up in the image, where a mast's sector is masked.
  std::vector<std::uint8_t> mask(320 * 240, 255);
  for (int row = 0; row < 115; ++row) std::fill_n(mask.begin() + row * 320 + 150, 20, 0);
  const CameraCheck check = check_with(
      {{"roll_deg = 2", "roll_deg = 0"}, {"pitch_deg = -3", ""}, {"yaw_deg = 5", ""}}, mask);
  EXPECT_GT(check.masked, 0.02);
  ASSERT_FALSE(check.blind.empty());
  EXPECT_LT(check.blind.front().from, check.blind.front().to);
  EXPECT_NEAR(check.blind.front().from + check.blind.front().to, 0, radians(20));
}

TEST(CameraCheck, WarnsOfLikelyMistakesOnly) {
  EXPECT_THAT(check_with({}).warnings, Not(Contains(HasSubstr("range_min_m"))));
  EXPECT_THAT(check_with({{"columns = 360", "columns = 1440"}}).warnings,
              Contains(HasSubstr("panorama.columns")));
  EXPECT_THAT(check_with({}).warnings, Contains(HasSubstr("columns wide, too few")));
  EXPECT_THAT(check_with({{"columns = 360", "columns = 1440"}}).warnings,
              Not(Contains(HasSubstr("columns wide, too few"))));
  EXPECT_THAT(check_with({{"range_min_m = 0.9", "range_min_m = 0.9\n[search]\nrange_m = [0.5, 8]"}})
                  .warnings,
              Contains(HasSubstr("search.range_m")));
  const std::vector<std::uint8_t> top_only = [] {
    std::vector<std::uint8_t> mask(320 * 240, 0);
    std::fill_n(mask.begin(), 320 * 60, 255);
    return mask;
  }();
  const auto warnings = check_with({}, top_only).warnings;
  EXPECT_THAT(warnings, Contains(HasSubstr("of the panorama is seen")));
}

TEST(CameraCheck, WarnsOfSidesThatNoCameraLookingUpHas) {
  const auto up = [](const char* left) {
    return check_with({{"left = \"image right\"",
                        std::string("centre = \"up\"\nleft = \"image ") + left + "\""}})
        .warnings;
  };
  EXPECT_THAT(up("left"), Contains(HasSubstr("flipped")));
  EXPECT_THAT(up("right"), Not(Contains(HasSubstr("flipped"))));
}

TEST(CameraCheck, IsTextForPeopleAndOneLineOfJson) {
  const CameraCheck check = check_with({});
  const nlohmann::json json = nlohmann::json::parse(to_json(check));
  EXPECT_EQ(json.at("image_width"), 320);
  EXPECT_EQ(json.at("warnings").size(), check.warnings.size());
  EXPECT_THAT(to_text(check), HasSubstr("320 x 240"));
}

TEST(CameraCheck, KnowsACameraThatLooksAhead) {
  const test::TemporaryFolder folder;
  const Camera camera = load_camera(write_pinhole(folder));
  const CameraCheck check = check_camera(camera, build_warp_table(camera));
  EXPECT_EQ(check.model, "pinhole");
  EXPECT_FALSE(check.inverse);
  EXPECT_FALSE(check.panorama.wraps());
  EXPECT_THAT(to_text(check), HasSubstr("bearings -"));
}

}  // namespace
}  // namespace bole
