#include "capture/v4l2/controls.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <utility>
#include "base/errors.h"

namespace bole {
namespace {

constexpr int kExposureUnitUs = 100;  // of V4L2_CID_EXPOSURE_ABSOLUTE

int write_control(const V4l2Device& device, std::uint32_t id, int value) {
  v4l2_control control{id, value};
  return device.ask(VIDIOC_S_CTRL, &control);
}

std::optional<int> read_control(const V4l2Device& device, std::uint32_t id) {
  v4l2_control control{id, 0};
  if (device.ask(VIDIOC_G_CTRL, &control) != 0) return std::nullopt;
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

  void tell(std::string line) { refused_.push_back(std::move(line)); }

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

void set_exposure_mode(Writer& writer, const CameraSettings& settings,
                       const std::optional<ExposureRange>& range) {
  using Exposure = CameraSettings::Exposure;
  if (settings.exposure == Exposure::automatic) {
    writer.set(as_written(settings.exposure), V4L2_CID_EXPOSURE_AUTO,
               {V4L2_EXPOSURE_AUTO, V4L2_EXPOSURE_APERTURE_PRIORITY});
  } else if (settings.exposure != Exposure::unchanged) {
    writer.set(as_written(settings.exposure), V4L2_CID_EXPOSURE_AUTO,
               {V4L2_EXPOSURE_MANUAL, V4L2_EXPOSURE_SHUTTER_PRIORITY});
    const std::string what = "exposure_us = " + std::to_string(settings.exposure_us);
    const int nearest_us = range ? range->nearest(settings.exposure_us) : settings.exposure_us;
    writer.set(what, V4L2_CID_EXPOSURE_ABSOLUTE, {std::max(nearest_us / kExposureUnitUs, 1)});
    // Within a step it is what was asked for.
    if (range && std::abs(nearest_us - settings.exposure_us) >= range->step_us) {
      writer.tell(what + ": the camera's nearest is " + std::to_string(nearest_us));
    }
  }
}

void set_white_balance(Writer& writer, const CameraSettings& settings) {
  using WhiteBalance = CameraSettings::WhiteBalance;
  if (settings.white_balance == WhiteBalance::unchanged) return;
  const bool automatic = settings.white_balance == WhiteBalance::automatic;
  writer.set(as_written(settings.white_balance), V4L2_CID_AUTO_WHITE_BALANCE, {automatic ? 1 : 0});
  if (automatic) return;
  writer.set("white_balance_k = " + std::to_string(settings.white_balance_k),
             V4L2_CID_WHITE_BALANCE_TEMPERATURE, {settings.white_balance_k});
}

void set_power_line(Writer& writer, CameraSettings::PowerLine wanted) {
  using PowerLine = CameraSettings::PowerLine;
  const auto set = [&](int value) {
    writer.set(as_written(wanted), V4L2_CID_POWER_LINE_FREQUENCY, {value});
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
  set_exposure_mode(writer, settings, exposure_range(device));
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
  v4l2_control control{V4L2_CID_EXPOSURE_ABSOLUTE, exposure_us / kExposureUnitUs};
  return device.call(VIDIOC_S_CTRL, &control) == 0;
}

std::optional<ExposureRange> exposure_range(const V4l2Device& device) {
  v4l2_queryctrl query{};
  query.id = V4L2_CID_EXPOSURE_ABSOLUTE;
  if (device.ask(VIDIOC_QUERYCTRL, &query) != 0) return std::nullopt;
  constexpr int kLongest = 10'000'000 / kExposureUnitUs;
  const int min = std::clamp(query.minimum, 1, kLongest);
  const int max = std::clamp(query.maximum, min, kLongest);
  const int step = std::clamp(query.step, 1, kLongest);
  return ExposureRange{min * kExposureUnitUs, max * kExposureUnitUs, step * kExposureUnitUs};
}

}  // namespace bole
