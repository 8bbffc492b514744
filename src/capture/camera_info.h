#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/image.h"

namespace bole {

/// A format and size that a camera offers, with the frame rates it has for them.
struct CameraMode {
  std::string format;                 ///< as the driver calls it
  std::optional<PixelFormat> pixels;  ///< ours; none: it cannot be read
  ImageSize size;
  std::vector<double> rates_hz;  ///< empty: the driver does not say
};

struct CameraControl {
  std::string name;
  std::optional<double> min, max, fallback, value;  ///< as far as the driver says
};

/// A camera that is there, as `bolectl cameras` shows it.
struct CameraInfo {
  std::string source;  ///< what --source takes; stays the same over replugs where it can
  std::string model;
  std::string driver;
  std::vector<std::string> other_names;
  std::vector<CameraMode> modes;
  std::vector<CameraControl> controls;
};

}  // namespace bole
