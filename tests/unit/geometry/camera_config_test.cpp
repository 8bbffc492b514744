#include "geometry/camera_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "geometry/angles.h"
#include "support/config_problem.h"

namespace bole {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::string_view kOmni = R"(
[camera]
model = "ocam"
calibration = "calib_results.txt"
mask = "mask.png"
[mount]
height_m = 1.05
forward = "image up"
left = "image right"
centre = "down"
roll_deg = 1.3
pitch_deg = -0.8
yaw_deg = 4.0
[panorama]
columns = 1440
elevation_top_deg = 27
range_min_m = 0.9
[search]
range_m = [1.0, 8.0]
diameter_m = [0.2, 0.8]
)";

constexpr std::string_view kPhoto = R"(
[camera]
model = "pinhole"
horizontal_fov_deg = 60
width = 640
height = 480
[mount]
height_m = 1.5
horizon_row = 350
[panorama]
range_min_m = 2
)";

CameraConfig parse(std::string_view text) { return parse_camera_config(text, "camera.toml"); }

std::string with(std::string_view base, const std::string& from, const std::string& to) {
  std::string text(base);
  return text.replace(text.find(from), from.size(), to);
}

std::string problem_of(const std::string& text) {
  const std::string problem = test::config_problem([&] { parse(text); });
  if (problem != "none") {
    EXPECT_THAT(problem, AllOf(HasSubstr("camera.toml: "), Not(HasSubstr("\n"))));
  }
  return problem;
}

std::string omni_problem(const std::string& from, const std::string& to) {
  return problem_of(with(kOmni, from, to));
}

TEST(CameraConfig, ReadsEveryKeyInSiUnits) {
  const CameraConfig config = parse(kOmni);
  EXPECT_EQ(config.model, CameraConfig::Model::ocam);
  EXPECT_EQ(config.calibration, "calib_results.txt");
  EXPECT_EQ(config.mask, "mask.png");
  EXPECT_EQ(config.mount.height, 1.05);
  EXPECT_EQ(config.mount.left, ImageSide::right);
  EXPECT_TRUE(config.mount.centre_looks_down);
  EXPECT_DOUBLE_EQ(config.mount.roll, radians(1.3));
  EXPECT_DOUBLE_EQ(config.mount.pitch, radians(-0.8));
  EXPECT_DOUBLE_EQ(config.mount.yaw, radians(4));
  EXPECT_EQ(panorama_of(config).rows, 385);
  EXPECT_EQ(config.search.range.high, 8.0);
  EXPECT_EQ(config.search.diameter.low, 0.2);
}

TEST(CameraConfig, APhotographNeedsNoCalibration) {
  const CameraConfig config = parse(kPhoto);
  EXPECT_EQ(config.model, CameraConfig::Model::pinhole);
  EXPECT_DOUBLE_EQ(config.horizontal_fov, radians(60));
  EXPECT_EQ(config.size, (ImageSize{640, 480}));
  EXPECT_EQ(config.horizon_row, 350);
}

TEST(CameraConfig, OpenCvsOmnidirectionalModelsAreMountedAsOcamIs) {
  for (const std::string name : {"fisheye", "omnidir"}) {
    const CameraConfig config = parse(with(kOmni, "ocam", name));
    EXPECT_EQ(name_of(config.model), name);
    EXPECT_EQ(config.mount.left, ImageSide::right);
    EXPECT_EQ(config.size.width, 0);
    const std::string sized =
        with(kOmni, "\"ocam\"", "\"" + name + "\"\nwidth = 640\nheight = 480");
    EXPECT_EQ(parse(sized).size, (ImageSize{640, 480}));
    EXPECT_THAT(problem_of(with(sized, "height = 480\n", "")), HasSubstr("camera.height"));
    EXPECT_THAT(problem_of(with(sized, "pitch_deg = -0.8", "horizon_row = 3")),
                HasSubstr("mount.horizon_row: is not a known key"));
    EXPECT_THAT(problem_of(with(sized, "calibration = \"calib_results.txt\"\n", "")),
                HasSubstr("camera.calibration: is missing; name OpenCV's YAML"));
  }
}

std::string example(const std::string& name) {
  return read_text_file(BOLE_SOURCE_DIR "/calib/" + name + "/camera.toml", 1 << 16);
}

std::string without_comment(const std::string& text, const std::string& line) {
  return with(text, "# " + line, line);
}

TEST(CameraConfig, TheExampleSaysTheDefaults) {
  const CameraConfig said = parse(example("example"));
  const CameraConfig config =
      parse("[camera]\ncalibration = \"calib_results.txt\"\n[mount]\nheight_m = 1.05\n");
  EXPECT_EQ(config.model, said.model);
  EXPECT_EQ(config.mount.forward, ImageSide::up);
  EXPECT_EQ(config.mount.left, ImageSide::left);
  EXPECT_TRUE(config.mount.centre_looks_down);
  EXPECT_EQ(config.mount.roll, 0);
  EXPECT_EQ(config.mount.pitch, 0);
  EXPECT_EQ(config.mount.yaw, 0);
  EXPECT_EQ(panorama_of(config), panorama_of(said));
  EXPECT_EQ(config.search.range.low, said.search.range.low);
  EXPECT_EQ(config.search.range.high, said.search.range.high);
  EXPECT_EQ(config.search.diameter.low, said.search.diameter.low);
  EXPECT_EQ(config.search.diameter.high, said.search.diameter.high);
}

TEST(CameraConfig, WhatTheExamplesShowInCommentsIsKnown) {
  const std::string fisheye = example("fisheye"), pinhole = example("pinhole");
  EXPECT_EQ(parse(with(fisheye, "\"fisheye\" ", "\"omnidir\" ")).model,
            CameraConfig::Model::omnidir);
  EXPECT_EQ(parse(without_comment(without_comment(fisheye, "width"), "height")).size,
            (ImageSize{960, 960}));
  EXPECT_FALSE(parse(without_comment(with(pinhole, "horizon_row = 200", ""), "pitch_deg"))
                   .horizon_row.has_value());
  EXPECT_EQ(parse(without_comment(with(pinhole, "horizontal_fov_deg = 60", ""), "calibration"))
                .calibration,
            "camera.yml");
}

TEST(CameraConfig, EveryModelIsNamedAsItIsWritten) {
  EXPECT_EQ(name_of(parse(kOmni).model), "ocam");
  EXPECT_EQ(name_of(parse(kPhoto).model), "pinhole");
  EXPECT_TRUE(looks_all_round(parse(kOmni).model));
  EXPECT_FALSE(looks_all_round(parse(kPhoto).model));
}

TEST(CameraConfig, UnknownKeysAreNamedWhereverTheyStand) {
  EXPECT_THAT(omni_problem("mask =", "mesk ="), HasSubstr("camera.mesk: is not a known key"));
  EXPECT_THAT(omni_problem("roll_deg", "roll"), HasSubstr("mount.roll"));
  EXPECT_THAT(omni_problem("columns", "colums"), HasSubstr("panorama.colums"));
  EXPECT_THAT(omni_problem("diameter_m", "diameter"), HasSubstr("search.diameter"));
  EXPECT_THAT(omni_problem("[search]", "[serach]"), HasSubstr("serach"));
  EXPECT_THAT(omni_problem("calibration", "width = 640\ncalibration"), HasSubstr("camera.width"));
}

TEST(CameraConfig, OutOfRangeValuesAreNamedWithTheirKey) {
  EXPECT_THAT(omni_problem("1.05", "-1.05"), HasSubstr("mount.height_m: is -1.05"));
  EXPECT_THAT(omni_problem("1.05", "0"), HasSubstr("mount.height_m"));
  EXPECT_THAT(omni_problem("1.05", "nan"), HasSubstr("mount.height_m"));
  EXPECT_THAT(omni_problem("1.05", "inf"), HasSubstr("mount.height_m"));
  EXPECT_THAT(omni_problem("[1.0, 8.0]", "[8.0, 1.0]"), HasSubstr("search.range_m"));
  EXPECT_THAT(omni_problem("[1.0, 8.0]", "[1.0]"), HasSubstr("search.range_m"));
  EXPECT_THAT(omni_problem("[1.0, 8.0]", "[1.0, nan]"), HasSubstr("search.range_m"));
  EXPECT_THAT(omni_problem("[0.2, 0.8]", "[0, 0.8]"), HasSubstr("search.diameter_m"));
  EXPECT_THAT(omni_problem("[0.2, 0.8]", "[0.2, \"wide\"]"), HasSubstr("search.diameter_m"));
  EXPECT_THAT(omni_problem("1440", "0"), HasSubstr("panorama.columns"));
  EXPECT_THAT(omni_problem("1440", "1441"), HasSubstr("panorama.columns"));
  EXPECT_THAT(omni_problem("1440", "1e9"), HasSubstr("panorama.columns"));
  EXPECT_THAT(omni_problem("= 0.9", "= 0"), HasSubstr("panorama.range_min_m"));
  EXPECT_THAT(omni_problem("= 27", "= 90"), HasSubstr("panorama.elevation_top_deg"));
}

TEST(CameraConfig, APanoramaWithHardlyAnyOrTooManyRowsIsRefused) {
  EXPECT_THAT(omni_problem("= 27", "= -30"), HasSubstr("none"));
  EXPECT_THAT(problem_of(with(with(kOmni, "= 27", "= -30"), "= 0.9", "= 2")), HasSubstr("rows"));
  EXPECT_THAT(omni_problem("= 0.9", "= 0.05"), HasSubstr("none"));
  EXPECT_THAT(problem_of(with(with(kOmni, "= 0.9", "= 0.05"), "1440", "8192")), HasSubstr("rows"));
}

TEST(CameraConfig, MissingOrMistypedKeysAreNamed) {
  EXPECT_THAT(problem_of(""), HasSubstr("camera"));
  EXPECT_THAT(omni_problem("height_m = 1.05\n", ""), HasSubstr("mount.height_m: is missing"));
  EXPECT_THAT(omni_problem("1.05", "\"1.05\""), HasSubstr("mount.height_m: is not a number"));
  EXPECT_THAT(omni_problem("calibration = \"calib_results.txt\"\n", ""),
              HasSubstr("camera.calibration: is missing"));
  EXPECT_THAT(omni_problem("\"ocam\"", "\"laser\""), HasSubstr("camera.model"));
  EXPECT_THAT(omni_problem("[mount]", "mount = 3\n[moved]"), HasSubstr("mount"));
  EXPECT_THAT(omni_problem("image right", "image down"), HasSubstr("same axis as forward"));
  EXPECT_THAT(omni_problem("image right", "right"), HasSubstr("mount.left"));
  EXPECT_THAT(omni_problem("[mount]", "[mount"), HasSubstr("line "));
}

TEST(CameraConfig, APhotographsHorizonOrPitchNotBoth) {
  EXPECT_THAT(problem_of(with(kPhoto, "horizon_row = 350", "horizon_row = 350\npitch_deg = 2")),
              HasSubstr("mount.horizon_row"));
  EXPECT_THAT(problem_of(with(kPhoto, "60", "180")), HasSubstr("camera.horizontal_fov_deg"));
  EXPECT_THAT(problem_of(with(kPhoto, "640", "-640")), HasSubstr("camera.width"));
  EXPECT_THAT(problem_of(with(kPhoto, "640", "640.5")), HasSubstr("camera.width"));
  EXPECT_THAT(problem_of(with(kPhoto, "1.5\n", "1.5\nleft = \"image left\"\n")),
              HasSubstr("mount.left"));
}

}  // namespace
}  // namespace bole
