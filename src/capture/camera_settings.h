#pragma once

#include <optional>
#include <string>

#include "base/image.h"
#include "base/toml_table.h"

namespace bole {

/// What is asked of a camera, whatever drives it. What is left open stays as the camera has it.
struct CameraSettings {
  enum class Exposure {
    unchanged,
    automatic,  ///< the camera's own metering, sky and chassis included
    fixed,      ///< exposure_us
    metered,    ///< by us, on the panorama, beginning with exposure_us
  };
  enum class WhiteBalance { unchanged, automatic, fixed };
  enum class PowerLine { unchanged, off, hz50, hz60, automatic };

  std::optional<PixelFormat> format;  ///< none: the cheapest one for us that the camera has
  ImageSize size;                     ///< what the calibration holds for
  double frame_rate = 0;              ///< frames a second; 0: as the camera has it
  int buffers = 4;
  Exposure exposure = Exposure::unchanged;
  int exposure_us = 10'000;
  std::optional<double> gain;  ///< in the camera's own unit (libcamera: a factor)
  WhiteBalance white_balance = WhiteBalance::unchanged;
  int white_balance_k = 5'000;  ///< kelvin
  PowerLine power_line = PowerLine::unchanged;
};

/// Reads these keys of boled.toml's table [source], beside which others may stand; `size` is left
/// for the calibration to fill in. Throws ConfigError.
CameraSettings read_camera_settings(TomlTable& table);

/// A setting as it stands in boled.toml: exposure = "metered".
std::string as_written(CameraSettings::Exposure exposure);
std::string as_written(CameraSettings::WhiteBalance white_balance);
std::string as_written(CameraSettings::PowerLine power_line);

}  // namespace bole
