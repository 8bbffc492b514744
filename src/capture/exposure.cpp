#include "capture/exposure.h"

#include <algorithm>
#include <cmath>

namespace bole {

ExposureController::ExposureController(ExposureRange range, int start_us)
    : range_(range), exposure_us_(std::clamp(start_us, range.min_us, range.max_us)) {}

std::optional<int> ExposureController::update(double mean) {
  if (settling_ > 0) {
    --settling_;
    return std::nullopt;
  }
  const double ratio = kTarget / std::max(mean, 1.0);
  if (std::abs(ratio - 1) <= kTolerance) return std::nullopt;
  // Proportional on a linear sensor; a camera's gamma makes the true response flatter, so that
  // this falls short of the target rather than swinging beyond it.
  const double wanted = exposure_us_ * std::clamp(ratio, 1 / kLargestStep, kLargestStep);
  const double chosen = std::clamp<double>(wanted, range_.min_us, range_.max_us);
  if (chosen == exposure_us_) return std::nullopt;
  exposure_us_ = chosen;
  settling_ = kFramesToSettle;
  return static_cast<int>(std::lround(chosen));
}

}  // namespace bole
