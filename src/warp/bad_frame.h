#pragma once

#include <stdexcept>
#include <string>

#include "base/image.h"

namespace bole {

/// A frame that cannot be used: damaged, cut short, or not of the size that was calibrated. It is
/// dropped and counted; the next one may be good.
class BadFrame : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  BadFrame(ImageSize got, ImageSize expected)
      : std::runtime_error("is " + shown(got) + ", the calibration's image is " + shown(expected)) {
  }
};

}  // namespace bole
