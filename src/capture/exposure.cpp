#include "capture/exposure.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace bole {

int ExposureRange::nearest(double exposure_us) const {
  const int whole_steps = (max_us - min_us) / step_us;
  const double steps = std::round((exposure_us - min_us) / step_us);
  return min_us + step_us * static_cast<int>(std::clamp<double>(steps, 0, whole_steps));
}

ExposureRange ExposureRange::held_below(std::chrono::nanoseconds frame_period) const {
  ExposureRange held = *this;
  const std::int64_t period_us = frame_period.count() / 1000;
  if (period_us > 0) {
    held.max_us = static_cast<int>(std::clamp<std::int64_t>(period_us, min_us, max_us));
  }
  return held;
}

ExposureController::ExposureController(ExposureRange range, int start_us)
    : range_(range), exposure_us_(range.nearest(start_us)) {}

std::optional<int> ExposureController::update(double mean) {
  if (settling_ > 0) {
    --settling_;
    return std::nullopt;
  }
  const double ratio = kTarget / std::max(mean, 1.0);
  const bool possible = exposure_us_ <= range_.max_us;
  if (possible && std::abs(ratio - 1) <= kTolerance) return std::nullopt;
  // Proportional on a linear sensor; a camera's gamma makes the true response flatter, so that
  // this falls short of the target rather than swinging beyond it.
  const double wanted = exposure_us_ * std::clamp(ratio, 1 / kLargestStep, kLargestStep);
  const int chosen = range_.nearest(wanted);
  if (chosen == exposure_us_) return std::nullopt;
  exposure_us_ = chosen;
  settling_ = kFramesToSettle;
  return chosen;
}

std::string Metering::start(const CameraSettings& settings, std::optional<ExposureRange> range) {
  stop();
  mean_ = kNone;
  if (settings.exposure != CameraSettings::Exposure::metered) return "";
  if (!range) return as_written(settings.exposure) + ": the camera names no exposure times";
  controller_.emplace(*range, settings.exposure_us);
  return "";
}

std::optional<int> Metering::due() {
  const double mean = mean_.exchange(kNone);
  if (!controller_ || mean == kNone) return std::nullopt;
  return controller_->update(mean);
}

}  // namespace bole
