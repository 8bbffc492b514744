#pragma once

#include <atomic>
#include <chrono>
#include <optional>
#include <string>

#include "capture/camera_settings.h"

namespace bole {

/// Exposure times that a camera can, in microseconds: from the shortest in whole steps.
struct ExposureRange {
  int min_us = 1;
  int max_us = 1;
  int step_us = 1;

  /// The one of them that lies nearest to `exposure_us`.
  int nearest(double exposure_us) const;
  /// Those no longer than a frame takes, beyond which a camera would give fewer frames. 0: unknown.
  ExposureRange held_below(std::chrono::nanoseconds frame_period) const;
};

/// Chooses exposure times so that the panorama, not sky or chassis, is well exposed. A change shows
/// only a few frames later, so that it waits that long before it judges again.
class ExposureController {
 public:
  ExposureController(ExposureRange range, int start_us);

  /// `mean`: of the panorama's seen pixels, 0 to 255, once a frame. The exposure time to set, or
  /// nullopt to leave it: within a tenth of the target, where the camera has none that comes nearer
  /// to it, or while the last change is on its way.
  std::optional<int> update(double mean);
  /// From now on, none longer than a frame.
  void hold_below(std::chrono::nanoseconds frame_period) {
    range_ = range_.held_below(frame_period);
  }

  static constexpr double kTarget = 110;  ///< mean to aim at: dark trunks keep their contrast
  static constexpr double kTolerance = 0.1;
  static constexpr double kLargestStep = 2;  ///< factor between two settings
  static constexpr int kFramesToSettle = 4;

 private:
  ExposureRange range_;
  int exposure_us_;  // as the camera has it
  int settling_ = 0;
};

/// What a camera's source keeps of metering: whoever processes its frames tells how bright they
/// are, the source asks what exposure that calls for.
class Metering {
 public:
  /// At each opening, where settings.exposure is metered; else nothing is metered. `range`: nullopt
  /// when the camera does not say. Returns why it is not metered though asked for; else empty.
  std::string start(const CameraSettings& settings, std::optional<ExposureRange> range);
  void stop() { controller_.reset(); }
  void hold_below(std::chrono::nanoseconds frame_period) {
    if (controller_) controller_->hold_below(frame_period);
  }
  /// As FrameSource::metered(). From any thread.
  void tell(double mean) noexcept { mean_ = mean; }
  /// The exposure time to set now, by the last brightness told of, each of which counts once.
  std::optional<int> due();

 private:
  static constexpr double kNone = -1;

  std::optional<ExposureController> controller_;
  std::atomic<double> mean_ = kNone;
};

}  // namespace bole
