#include "capture/camera_settings.h"

#include <algorithm>
#include <string>
#include <vector>

namespace bole {
namespace {

// The choice's place in `choices`, which stand in the order of the enumeration's values.
template <class Enumeration>
Enumeration enumerated(TomlTable& table, std::string_view key,
                       const std::vector<std::string>& choices) {
  const std::string value = table.choice(key, choices.front(), choices);
  return static_cast<Enumeration>(std::ranges::find(choices, value) - choices.begin());
}

std::optional<PixelFormat> read_format(TomlTable& table) {
  std::vector<std::string> choices = {"any"};
  for (int i = 0; i <= static_cast<int>(PixelFormat::mjpeg); ++i) {
    choices.emplace_back(name(static_cast<PixelFormat>(i)));
  }
  return pixel_format_from_name(table.choice("format", "any", choices));
}

}  // namespace

CameraSettings read_camera_settings(TomlTable& table) {
  CameraSettings settings;
  settings.format = read_format(table);
  settings.frame_rate = table.number("frame_rate", 0, {0, 1000});
  settings.buffers = table.integer("buffers", settings.buffers, {3, 32});
  settings.exposure = enumerated<CameraSettings::Exposure>(
      table, "exposure", {"unchanged", "automatic", "fixed", "metered"});
  settings.exposure_us = table.integer("exposure_us", settings.exposure_us, {1, 10'000'000});
  if (table.has("gain")) settings.gain = table.required_number("gain", {0, 1e6});
  settings.white_balance = enumerated<CameraSettings::WhiteBalance>(
      table, "white_balance", {"unchanged", "automatic", "fixed"});
  settings.white_balance_k =
      table.integer("white_balance_k", settings.white_balance_k, {1'000, 20'000});
  settings.power_line = enumerated<CameraSettings::PowerLine>(
      table, "power_line", {"unchanged", "off", "50 Hz", "60 Hz", "automatic"});
  return settings;
}

}  // namespace bole
