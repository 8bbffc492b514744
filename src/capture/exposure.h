#pragma once

#include <optional>

namespace bole {

/// Exposure times that a camera can, in microseconds.
struct ExposureRange {
  int min_us = 0;
  int max_us = 0;
};

/// Chooses exposure times so that the panorama, not sky or chassis, is well exposed. A change shows
/// only a few frames later, so that it waits that long before it judges again.
class ExposureController {
 public:
  ExposureController(ExposureRange range, int start_us);

  /// `mean`: of the panorama's seen pixels, 0 to 255, once a frame. The exposure time to set, or
  /// nullopt to leave it: within a tenth of the target, or while the last change is on its way.
  std::optional<int> update(double mean);

  static constexpr double kTarget = 110;  ///< mean to aim at: dark trunks keep their contrast
  static constexpr double kTolerance = 0.1;
  static constexpr double kLargestStep = 2;  ///< factor between two settings
  static constexpr int kFramesToSettle = 4;

 private:
  ExposureRange range_;
  double exposure_us_;
  int settling_ = 0;
};

}  // namespace bole
