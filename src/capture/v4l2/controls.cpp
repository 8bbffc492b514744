#include "capture/v4l2/controls.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace bole {
namespace {

constexpr int kExposureUnitUs = 100;  // of V4L2_CID_EXPOSURE_ABSOLUTE

int write_control(const V4l2Device& device, std::uint32_t id, int value) {
  v4l2_control control{id, value};
  return device.call(VIDIOC_S_CTRL, &control);
}

std::optional<int> read_control(const V4l2Device& device, std::uint32_t id) {
  v4l2_control control{id, 0};
  if (device.call(VIDIOC_G_CTRL, &control) != 0) return std::nullopt;
  return control.value;
}

// Sets one control after the other and keeps what came of it.
class Writer {
 public:
  explicit Writer(const V4l2Device& device) : device_(device) {}

  // The first of `values` that the camera takes.
  void set(const std::string& what, std::uint32_t id, std::initializer_list<int> values) {
    int error = 0;
    for (const int value : values) {
      error = write_control(device_, id, value);
      if (error == 0) {
        check(what, id, value);
        return;
      }
    }
    refused_.push_back(what + ": " +
                       (error == EINVAL ? "the camera has no such setting" : error_text(error)));
  }

  // Sets a control that only some cameras have and that nobody asked for by name.
  void set_quietly(std::uint32_t id, int value) { write_control(device_, id, value); }

  std::vector<std::string> refused() && { return std::move(refused_); }

 private:
  void check(const std::string& what, std::uint32_t id, int value) {
    const std::optional<int> actual = read_control(device_, id);
    if (actual && *actual != value) {
      refused_.push_back(what + ": the camera takes " + std::to_string(*actual) + " for " +
                         std::to_string(value));
    }
  }

  const V4l2Device& device_;
  std::vector<std::string> refused_;
};

void set_exposure_mode(Writer& writer, const CameraSettings& settings) {
  using Exposure = CameraSettings::Exposure;
  if (settings.exposure == Exposure::automatic) {
    writer.set("exposure = \"automatic\"", V4L2_CID_EXPOSURE_AUTO,
               {V4L2_EXPOSURE_AUTO, V4L2_EXPOSURE_APERTURE_PRIORITY});
  } else if (settings.exposure != Exposure::unchanged) {
    writer.set("exposure = \"fixed\"", V4L2_CID_EXPOSURE_AUTO,
               {V4L2_EXPOSURE_MANUAL, V4L2_EXPOSURE_SHUTTER_PRIORITY});
    writer.set("exposure_us = " + std::to_string(settings.exposure_us), V4L2_CID_EXPOSURE_ABSOLUTE,
               {std::max(settings.exposure_us / kExposureUnitUs, 1)});
  }
}

void set_white_balance(Writer& writer, const CameraSettings& settings) {
  using WhiteBalance = CameraSettings::WhiteBalance;
  if (settings.white_balance == WhiteBalance::unchanged) return;
  const bool automatic = settings.white_balance == WhiteBalance::automatic;
  writer.set("white_balance", V4L2_CID_AUTO_WHITE_BALANCE, {automatic ? 1 : 0});
  if (automatic) return;
  writer.set("white_balance_k = " + std::to_string(settings.white_balance_k),
             V4L2_CID_WHITE_BALANCE_TEMPERATURE, {settings.white_balance_k});
}

void set_power_line(Writer& writer, CameraSettings::PowerLine wanted) {
  using PowerLine = CameraSettings::PowerLine;
  const auto set = [&](int value) {
    writer.set("power_line", V4L2_CID_POWER_LINE_FREQUENCY, {value});
  };
  switch (wanted) {
    case PowerLine::unchanged:
      break;
    case PowerLine::off:
      set(V4L2_CID_POWER_LINE_FREQUENCY_DISABLED);
      break;
    case PowerLine::hz50:
      set(V4L2_CID_POWER_LINE_FREQUENCY_50HZ);
      break;
    case PowerLine::hz60:
      set(V4L2_CID_POWER_LINE_FREQUENCY_60HZ);
      break;
    case PowerLine::automatic:
      set(V4L2_CID_POWER_LINE_FREQUENCY_AUTO);
      break;
  }
}

}  // namespace

std::vector<std::string> apply_controls(const V4l2Device& device, const CameraSettings& settings) {
  Writer writer(device);
  set_exposure_mode(writer, settings);
  if (settings.gain) {
    writer.set_quietly(V4L2_CID_AUTOGAIN, 0);
    const int gain = static_cast<int>(std::lround(*settings.gain));
    writer.set("gain = " + std::to_string(gain), V4L2_CID_GAIN, {gain});
  }
  set_white_balance(writer, settings);
  set_power_line(writer, settings.power_line);
  return std::move(writer).refused();
}

bool set_exposure(const V4l2Device& device, int exposure_us) {
  return write_control(device, V4L2_CID_EXPOSURE_ABSOLUTE,
                       std::max(exposure_us / kExposureUnitUs, 1)) == 0;
}

ExposureRange exposure_range(const V4l2Device& device) {
  v4l2_queryctrl query{};
  query.id = V4L2_CID_EXPOSURE_ABSOLUTE;
  if (device.call(VIDIOC_QUERYCTRL, &query) != 0) return {};
  constexpr int kLongest = 10'000'000 / kExposureUnitUs;
  return {std::clamp(query.minimum, 1, kLongest) * kExposureUnitUs,
          std::clamp(query.maximum, 1, kLongest) * kExposureUnitUs};
}

}  // namespace bole
