#include "controls.h"

#include <algorithm>

#include "descriptors.h"
#include "uvc_requests.h"

namespace hil {

// Units as UVC gives them: exposure time in 100 us, white balance in kelvin. The resolution of the
// exposure mode is the set of modes there are: 1 manual, 8 aperture priority.
Controls::Controls()
    : controls_{
          {"exposure_mode", kCameraTerminal, 0x02, 1, 1, 8, 0b1001, 8},
          {"exposure_time", kCameraTerminal, 0x04, 4, 1, 10000, 1, 156},
          {"brightness", kProcessingUnit, 0x02, 2, 0, 255, 1, 128},
          {"gain", kProcessingUnit, 0x04, 2, 0, 255, 1, 16},
          {"power_line_frequency", kProcessingUnit, 0x05, 1, 0, 2, 1, 1},
          {"white_balance_temperature", kProcessingUnit, 0x0a, 2, 2800, 6500, 10, 4600},
          {"white_balance_automatic", kProcessingUnit, 0x0b, 1, 0, 1, 1, 1},
      } {}

Control* Controls::find(unsigned entity, unsigned selector) {
  const auto found = std::ranges::find_if(controls_, [&](const Control& control) {
    return control.entity == entity && control.selector == selector;
  });
  return found == controls_.end() ? nullptr : &*found;
}

Control* Controls::find(std::string_view name) {
  const auto found = std::ranges::find(controls_, name, &Control::name);
  return found == controls_.end() ? nullptr : &*found;
}

std::optional<Bytes> read_control(const Control& control, unsigned request) {
  const auto value = [&](int32_t number) {
    return ByteWriter().little_endian(static_cast<uint32_t>(number), control.size_bytes).take();
  };
  switch (request) {
    case uvc::kGetCur:
      return value(control.current);
    case uvc::kGetMin:
      return value(control.minimum);
    case uvc::kGetMax:
      return value(control.maximum);
    case uvc::kGetRes:
      return value(control.resolution);
    case uvc::kGetDef:
      return value(control.default_value);
    case uvc::kGetLen:
      return ByteWriter().u16(unsigned(control.size_bytes)).take();
    case uvc::kGetInfo:
      return ByteWriter().u8({uvc::kCanGetAndSet}).take();
    default:
      return std::nullopt;
  }
}

}  // namespace hil
