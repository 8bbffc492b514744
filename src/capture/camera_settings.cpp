#include "capture/camera_settings.h"

#include <algorithm>
#include <string>
#include <vector>

namespace bole {
namespace {

// A key and its choices, in the order of the enumeration's values.
struct Choices {
  std::string key;
  std::vector<std::string> values;
};
const Choices kExposures{"exposure", {"unchanged", "automatic", "fixed", "metered"}};
const Choices kWhiteBalances{"white_balance", {"unchanged", "automatic", "fixed"}};
const Choices kPowerLines{"power_line", {"unchanged", "off", "50 Hz", "60 Hz", "automatic"}};

template <class Enumeration>
Enumeration read(TomlTable& table, const Choices& choices) {
  const std::string value = table.choice(choices.key, choices.values.front(), choices.values);
  return static_cast<Enumeration>(std::ranges::find(choices.values, value) -
                                  choices.values.begin());
}

template <class Enumeration>
std::string written(const Choices& choices, Enumeration value) {
  return choices.key + " = \"" + choices.values.at(static_cast<std::size_t>(value)) + "\"";
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
  settings.exposure = read<CameraSettings::Exposure>(table, kExposures);
  settings.exposure_us = table.integer("exposure_us", settings.exposure_us, {1, 10'000'000});
  if (table.has("gain")) settings.gain = table.required_number("gain", {0, 1e6});
  settings.white_balance = read<CameraSettings::WhiteBalance>(table, kWhiteBalances);
  settings.white_balance_k =
      table.integer("white_balance_k", settings.white_balance_k, {1'000, 20'000});
  settings.power_line = read<CameraSettings::PowerLine>(table, kPowerLines);
  return settings;
}

std::string as_written(CameraSettings::Exposure exposure) { return written(kExposures, exposure); }

std::string as_written(CameraSettings::WhiteBalance white_balance) {
  return written(kWhiteBalances, white_balance);
}

std::string as_written(CameraSettings::PowerLine power_line) {
  return written(kPowerLines, power_line);
}

}  // namespace bole
