#pragma once

#include <chrono>
#include <optional>

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

  static constexpr double kTarget = 110;  ///< mean to aim at: dark trunks keep their contrast
  static constexpr double kTolerance = 0.1;
  static constexpr double kLargestStep = 2;  ///< factor between two settings
  static constexpr int kFramesToSettle = 4;

 private:
  ExposureRange range_;
  int exposure_us_;  // as the camera has it
  int settling_ = 0;
};

}  // namespace bole
