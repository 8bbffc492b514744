#include "capture/libcamera/settings.h"

#include <libcamera/control_ids.h>
#include <libcamera/version.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <sstream>
#include <type_traits>

#define BOLE_LIBCAMERA_FROM(major, minor) \
  (LIBCAMERA_VERSION_MAJOR > (major) ||   \
   (LIBCAMERA_VERSION_MAJOR == (major) && LIBCAMERA_VERSION_MINOR >= (minor)))

namespace bole {
namespace {

namespace controls = libcamera::controls;

// Fills a list with controls, as far as the camera has them.
class Writer {
 public:
  Writer(const libcamera::Camera& camera, std::vector<std::string>& refused)
      : known_(camera.controls()), list_(controls::controls), refused_(refused) {}

  template <class Control, class Value>
  void set(const std::string& what, const Control& control, const Value& value) {
    if (known_.find(&control) == known_.end()) {
      refused_.push_back(what + ": the camera has no such control");
    } else {
      list_.set(control, value);
    }
  }
  void refuse(const std::string& what) {
    refused_.push_back(what + ": this libcamera has no such control");
  }
  libcamera::ControlList list() && { return std::move(list_); }

 private:
  const libcamera::ControlInfoMap& known_;
  libcamera::ControlList list_;
  std::vector<std::string>& refused_;
};

void set_exposure_mode(Writer& writer, const CameraSettings& settings) {
  using Exposure = CameraSettings::Exposure;
  if (settings.exposure == Exposure::unchanged) return;
  const bool automatic = settings.exposure == Exposure::automatic;
#if BOLE_LIBCAMERA_FROM(0, 5)
  writer.set(as_written(settings.exposure), controls::ExposureTimeMode,
             automatic ? static_cast<std::int32_t>(controls::ExposureTimeModeAuto)
                       : static_cast<std::int32_t>(controls::ExposureTimeModeManual));
#else
  writer.set(as_written(settings.exposure), controls::AeEnable, automatic);
#endif
  if (automatic) return;
  writer.set("exposure_us = " + std::to_string(settings.exposure_us), controls::ExposureTime,
             static_cast<std::int32_t>(settings.exposure_us));
}

void set_gain(Writer& writer, double gain) {
#if BOLE_LIBCAMERA_FROM(0, 5)
  writer.set("gain", controls::AnalogueGainMode,
             static_cast<std::int32_t>(controls::AnalogueGainModeManual));
#endif
  writer.set("gain = " + std::to_string(gain), controls::AnalogueGain, static_cast<float>(gain));
}

void set_white_balance(Writer& writer, const CameraSettings& settings) {
  using WhiteBalance = CameraSettings::WhiteBalance;
  if (settings.white_balance == WhiteBalance::unchanged) return;
  const bool automatic = settings.white_balance == WhiteBalance::automatic;
  writer.set(as_written(settings.white_balance), controls::AwbEnable, automatic);
  if (automatic) return;
  const std::string what = "white_balance_k = " + std::to_string(settings.white_balance_k);
#if BOLE_LIBCAMERA_FROM(0, 4)
  writer.set(what, controls::ColourTemperature,
             static_cast<std::int32_t>(settings.white_balance_k));
#else
  writer.refuse(what);  // there the control tells a temperature and takes none
#endif
}

void set_power_line(Writer& writer, CameraSettings::PowerLine wanted) {
  using PowerLine = CameraSettings::PowerLine;
  if (wanted == PowerLine::unchanged) return;
#if BOLE_LIBCAMERA_FROM(0, 2)
  const auto mode = [&](std::int32_t value) {
    writer.set(as_written(wanted), controls::AeFlickerMode, value);
  };
  if (wanted == PowerLine::off) return mode(controls::FlickerOff);
  if (wanted == PowerLine::automatic) return mode(controls::FlickerAuto);
  mode(controls::FlickerManual);
  // Lamps flicker at twice the line's frequency.
  writer.set(as_written(wanted), controls::AeFlickerPeriod,
             std::int32_t{wanted == PowerLine::hz50 ? 10'000 : 8'333});
#else
  writer.refuse(as_written(wanted));
#endif
}

void set_frame_rate(Writer& writer, double frame_rate) {
  if (frame_rate <= 0) return;
  const auto period_us = static_cast<std::int64_t>(1e6 / frame_rate);
  const std::array limits = {period_us, period_us};
  std::ostringstream what;
  what << "frame_rate = " << frame_rate;
  writer.set(what.str(), controls::FrameDurationLimits,
             libcamera::Span<const std::int64_t, 2>(limits));
}

std::optional<double> number(const libcamera::ControlValue& value) {
  if (value.isArray()) return std::nullopt;
  switch (value.type()) {
    case libcamera::ControlTypeBool:
      return value.get<bool>() ? 1 : 0;
    case libcamera::ControlTypeByte:
      return value.get<std::uint8_t>();
    case libcamera::ControlTypeInteger32:
      return value.get<std::int32_t>();
    case libcamera::ControlTypeInteger64:
      return static_cast<double>(value.get<std::int64_t>());
    case libcamera::ControlTypeFloat:
      return value.get<float>();
    default:
      return std::nullopt;
  }
}

}  // namespace

libcamera::ControlList make_controls(const libcamera::Camera& camera,
                                     const CameraSettings& settings,
                                     std::vector<std::string>& refused) {
  Writer writer(camera, refused);
  set_exposure_mode(writer, settings);
  if (settings.gain) set_gain(writer, *settings.gain);
  set_white_balance(writer, settings);
  set_power_line(writer, settings.power_line);
  set_frame_rate(writer, settings.frame_rate);
  return std::move(writer).list();
}

std::optional<ExposureRange> exposure_range(const libcamera::Camera& camera) {
  const auto found = camera.controls().find(&controls::ExposureTime);
  if (found == camera.controls().end()) return std::nullopt;
  const auto bound = [](const libcamera::ControlValue& value, int fallback) {
    constexpr double kLongestUs = 1e7;
    return static_cast<int>(std::clamp(number(value).value_or(fallback), 1.0, kLongestUs));
  };
  return ExposureRange{bound(found->second.min(), 1), bound(found->second.max(), 1'000'000)};
}

void set_exposure(libcamera::ControlList& list, int exposure_us) {
  list.set(controls::ExposureTime, static_cast<std::int32_t>(exposure_us));
}

std::vector<CameraControl> list_controls(const libcamera::Camera& camera) {
  std::vector<CameraControl> list;
  for (const auto& [id, info] : camera.controls()) {
    list.push_back({id->name(), number(info.min()), number(info.max()), number(info.def()), {}});
  }
  return list;
}

std::string libcamera_version() {
  return "libcamera " + std::to_string(LIBCAMERA_VERSION_MAJOR) + "." +
         std::to_string(LIBCAMERA_VERSION_MINOR) + "." + std::to_string(LIBCAMERA_VERSION_PATCH);
}

}  // namespace bole
