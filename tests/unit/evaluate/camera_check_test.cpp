#include "evaluate/camera_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "base/files.h"
#include "geometry/angles.h"
#include "unit/warp/test_cameras.h"

namespace bole {
namespace {

using testing::AllOf;
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

TEST(CameraCheck, JoinsABlindArcAcrossTheSeam) {
  // The panorama's seam looks backward, down in the image.
  std::vector<std::uint8_t> mask(320 * 240, 255);
  for (int row = 125; row < 240; ++row) std::fill_n(mask.begin() + row * 320 + 150, 20, 0);
  const CameraCheck check = check_with(
      {{"roll_deg = 2", "roll_deg = 0"}, {"pitch_deg = -3", ""}, {"yaw_deg = 5", ""}}, mask);
  ASSERT_EQ(check.blind.size(), 1U);
  EXPECT_GT(check.blind.front().from, radians(90));
  EXPECT_LT(check.blind.front().to, radians(-90));
  EXPECT_THAT(check.warnings, Not(Contains(HasSubstr("degrees of bearing"))));
}

TEST(CameraCheck, WarnsOfLikelyMistakesOnly) {
  EXPECT_THAT(check_with({}).warnings, Not(Contains(HasSubstr("range_min_m"))));
  const std::vector<std::uint8_t> top_only = [] {
    std::vector<std::uint8_t> mask(320 * 240, 0);
    std::fill_n(mask.begin(), 320 * 60, 255);
    return mask;
  }();
  const auto warnings = check_with({}, top_only).warnings;
  EXPECT_THAT(warnings, Contains(HasSubstr("of the panorama is seen")));
}

// The small camera searches small trunks, which its image hardly shows, or stout ones.
constexpr const char* kThin = "[search]\ndiameter_m = [0.2, 0.8]\n[panorama]";
constexpr const char* kStout = "[search]\ndiameter_m = [0.7, 0.8]\n[panorama]";

TEST(CameraCheck, SaysOnceWhatTheImageCannotResolve) {
  for (const char* columns : {"columns = 360", "columns = 1440"}) {
    const auto warnings = check_with({{"[panorama]", kThin}, {"columns = 360", columns}}).warnings;
    EXPECT_THAT(warnings, Contains(HasSubstr("the image resolves a trunk of 0.20 m only to 3.")));
    EXPECT_THAT(warnings, Not(Contains(HasSubstr("too few to be found"))));
  }
  const auto warnings =
      check_with({{"[panorama]", kThin}, {"columns = 360", "columns = 1440"}}).warnings;
  EXPECT_EQ(std::ranges::count_if(
                warnings, [](const auto& text) { return text.find("columns") != text.npos; }),
            1);
}

TEST(CameraCheck, AdvisesColumnsByWhatTheImageResolves) {
  EXPECT_THAT(check_with({{"[panorama]", kStout}}).warnings, Not(Contains(HasSubstr("columns"))));
  EXPECT_THAT(check_with({{"[panorama]", kStout}, {"columns = 360", "columns = 1440"}}).warnings,
              Contains(AllOf(HasSubstr("panorama.columns = 1440"), HasSubstr("would show as much"),
                             Not(HasSubstr("raise")))));
  EXPECT_THAT(check_with({{"[panorama]", kStout}, {"columns = 360", "columns = 256"}}).warnings,
              Contains(HasSubstr("raise panorama.columns to 288")));
}

TEST(CameraCheck, NeverAdvisesColumnsThatCameraTomlMayNotHave) {
  // A camera of so few pixels that 64 columns are more than it has.
  const test::TemporaryFolder folder;
  const Camera camera = load_camera(folder.write("camera.toml", R"(
[camera]
model = "pinhole"
horizontal_fov_deg = 90
width = 8
height = 8
[mount]
height_m = 1.5
[panorama]
columns = 720
range_min_m = 3
)"));
  const auto warnings = check_camera(camera, build_warp_table(camera)).warnings;
  EXPECT_THAT(warnings, Contains(HasSubstr(": 64 would show as much")));
}

TEST(CameraCheck, NamesWhatKeepsNearGroundOutOfSight) {
  const auto with = [](const char* search, const char* nearest) {
    return check_with({{"range_min_m = 0.9", std::string("range_min_m = ") + nearest +
                                                 "\n[search]\nrange_m = " + search}})
        .warnings;
  };
  EXPECT_THAT(with("[0.9, 8]", "0.9"), Not(Contains(HasSubstr("search.range_m begins"))));
  // The panorama ends above what the image shows.
  EXPECT_THAT(with("[0.5, 8]", "0.9"), Contains(HasSubstr("lower panorama.range_min_m to 0.50")));
  // The image itself ends.
  std::vector<std::uint8_t> mask(320 * 240, 255);
  for (int i = 0; i < 320 * 240; ++i) {
    if (std::hypot(i / 320 - 120.8, i % 320 - 159.1) < 50) mask[i] = 0;
  }
  const auto warnings = check_with({}, mask).warnings;
  EXPECT_THAT(warnings, Contains(AllOf(HasSubstr("the image shows the ground only from"),
                                       HasSubstr("check centre, roll_deg and pitch_deg first"),
                                       HasSubstr("begin range_m at"), Not(HasSubstr("lower")))));
  EXPECT_THAT(warnings, Contains(AllOf(HasSubstr("panorama.range_min_m = 0.90 is nearer"),
                                       HasSubstr("check centre, roll_deg and pitch_deg first"))));
}

TEST(CameraCheck, WarnsOfAGrosslyWrongMount) {
  const auto names_tilt = Contains(AllOf(HasSubstr("mount.roll_deg"), HasSubstr("centre says")));
  EXPECT_THAT(check_with({}).warnings, Not(names_tilt));
  EXPECT_THAT(check_with({{"pitch_deg = -3", "pitch_deg = 90"}}).warnings, names_tilt);
  EXPECT_THAT(check_with({{"roll_deg = 2", "roll_deg = 180"}}).warnings, names_tilt);
}

TEST(CameraCheck, NamesTheTiltsKeysFirstWhereTheCentreIsWrong) {
  // As of a mirror that ends some 25 degrees above the horizon.
  std::vector<std::uint8_t> mask(320 * 240, 0);
  for (int i = 0; i < 320 * 240; ++i) {
    if (std::hypot(i / 320 - 120.8, i % 320 - 159.1) < 110) mask[i] = 255;
  }
  const auto with_centre = [&](const std::string& centre) {
    return check_with({{"roll_deg = 2", "centre = \"" + centre + "\""}}, mask).warnings;
  };
  EXPECT_THAT(with_centre("up"),
              AllOf(Contains(AllOf(HasSubstr("of the panorama is seen"),
                                   HasSubstr("check centre, roll_deg and pitch_deg first"))),
                    Contains(AllOf(HasSubstr("range_min_m = 0.90 is nearer"),
                                   HasSubstr("check centre, roll_deg and pitch_deg first")))));
  EXPECT_THAT(with_centre("down"), Not(Contains(HasSubstr("centre,"))));
}

TEST(CameraCheck, WarnsOfBlindArcsThatAreNoMast) {
  std::vector<std::uint8_t> mask(320 * 240, 255);
  for (int row = 0; row < 240; ++row) {
    for (int column = 0; column < 320; ++column) {
      const double turn = std::abs(std::atan2(column - 159.1, 120.8 - row));
      if (turn < radians(20)) mask[row * 320 + column] = 0;
    }
  }
  EXPECT_THAT(check_with({}, mask).warnings,
              Contains(AllOf(HasSubstr("degrees of bearing"),
                             HasSubstr("check centre, roll_deg and pitch_deg first"))));
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

TEST(CameraCheck, TellsTheNearestGroundOfNearlyAllBearings) {
  CameraCheck check = check_with({{"roll_deg = 2", "roll_deg = 19"}});
  ASSERT_TRUE(check.nearest_ground);
  EXPECT_LE(check.nearest_ground->median, check.nearest_ground->p95);
  EXPECT_LT(check.nearest_ground->p95, 100);
  EXPECT_THAT(to_text(check), HasSubstr("at 95 % of bearings"));
}

TEST(CameraCheck, PrintsNoPixelsWhereHardlyAnyShowTheHorizon) {
  CameraCheck check = check_with({});
  check.pixels_a_degree = 0.01;
  EXPECT_THAT(to_text(check), HasSubstr("no pixel at the horizon"));
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

TEST(CameraCheck, NamesOnlyKeysThatTheCameraHas) {
  const test::TemporaryFolder folder;
  std::string text = read_text_file(write_pinhole(folder), 1 << 16);
  const auto warnings_with = [&](const std::string& tilt) {
    std::string changed = text;
    changed.replace(changed.find("horizon_row = 50"), 16, tilt);
    const Camera camera = load_camera(folder.write("camera.toml", changed));
    return check_camera(camera, build_warp_table(camera)).warnings;
  };
  const auto by_row = warnings_with("horizon_row = 200"),
             by_pitch = warnings_with("pitch_deg = -35");
  for (const auto& warnings : {by_row, by_pitch}) {
    EXPECT_THAT(warnings, Not(Contains(HasSubstr("centre"))));
    EXPECT_THAT(warnings, Not(Contains(HasSubstr("forward"))));
  }
  EXPECT_THAT(by_row, Contains(HasSubstr("horizon_row and roll_deg")));
  EXPECT_THAT(by_row, Not(Contains(HasSubstr("pitch_deg"))));
  EXPECT_THAT(by_pitch, Contains(HasSubstr("pitch_deg and roll_deg")));
}

TEST(CameraCheck, WarnsOfAModelThatCannotBeInverted) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = write_small_camera(folder);
  // Beyond some radius rays turn back.
  std::string optics(kSmallOcam);
  optics.replace(0, optics.find('\n'), "4 -45.6 0 8.1e-3 -5e-5");
  folder.write("calib.txt", optics);
  const Camera camera = load_camera(file);
  EXPECT_THAT(check_camera(camera, build_warp_table(camera)).warnings,
              Contains(HasSubstr("cannot be inverted")));
  EXPECT_THAT(check_with({}).warnings, Not(Contains(HasSubstr("cannot be inverted"))));
}

}  // namespace
}  // namespace bole
