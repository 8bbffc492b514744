#include "capture/camera_settings.h"

#include <gmock/gmock.h>

#include <string>

#include "support/config_problem.h"

namespace bole {
namespace {

using testing::HasSubstr;

CameraSettings read(const std::string& text) {
  TomlTable table(parse_toml(text, "boled.toml"), "boled.toml", "source");
  const CameraSettings settings = read_camera_settings(table);
  table.done();
  return settings;
}

std::string refusal(const std::string& text) {
  return test::config_problem([&] { read(text); });
}

TEST(CameraSettings, LeaveTheCameraAsItIsByDefault) {
  const CameraSettings settings = read("");
  EXPECT_FALSE(settings.format);
  EXPECT_FALSE(settings.gain);
  EXPECT_EQ(settings.frame_rate, 0);
  EXPECT_EQ(settings.exposure, CameraSettings::Exposure::unchanged);
  EXPECT_EQ(settings.white_balance, CameraSettings::WhiteBalance::unchanged);
  EXPECT_EQ(settings.power_line, CameraSettings::PowerLine::unchanged);
}

TEST(CameraSettings, AreReadByName) {
  const CameraSettings settings = read(
      "format = \"nv12\"\nframe_rate = 12.5\nbuffers = 6\nexposure = \"metered\"\n"
      "exposure_us = 4000\ngain = 0\nwhite_balance = \"fixed\"\nwhite_balance_k = 4200\n"
      "power_line = \"60 Hz\"\n");
  EXPECT_EQ(settings.format, PixelFormat::nv12);
  EXPECT_EQ(settings.frame_rate, 12.5);
  EXPECT_EQ(settings.buffers, 6);
  EXPECT_EQ(settings.exposure, CameraSettings::Exposure::metered);
  EXPECT_EQ(settings.exposure_us, 4000);
  EXPECT_EQ(settings.gain, 0);
  EXPECT_EQ(settings.white_balance, CameraSettings::WhiteBalance::fixed);
  EXPECT_EQ(settings.white_balance_k, 4200);
  EXPECT_EQ(settings.power_line, CameraSettings::PowerLine::hz60);
}

TEST(CameraSettings, ThatNoCameraCouldHaveAreRefused) {
  EXPECT_THAT(refusal("format = \"h264\"\n"), HasSubstr("source.format: is \"h264\""));
  EXPECT_THAT(refusal("buffers = 2\n"), HasSubstr("source.buffers: is 2"));
  EXPECT_THAT(refusal("frame_rate = -1\n"), HasSubstr("source.frame_rate"));
  EXPECT_THAT(refusal("exposure = \"bright\"\n"), HasSubstr("metered"));
  EXPECT_THAT(refusal("gain = nan\n"), HasSubstr("source.gain"));
  EXPECT_THAT(refusal("power_line = \"55 Hz\"\n"), HasSubstr("source.power_line"));
}

}  // namespace
}  // namespace bole
