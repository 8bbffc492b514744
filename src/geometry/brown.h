#pragma once

#include <array>
#include <optional>

#include "geometry/camera_matrix.h"

namespace bole {

/// Brown's lens distortion as OpenCV writes it, in the plane at distance 1.
class BrownDistortion {
 public:
  using Coefficients = std::array<double, 5>;  ///< k1, k2, p1, p2, k3

  explicit BrownDistortion(const Coefficients& coefficients);

  /// Where the lens shows `point`; nullopt beyond the radius up to which the image grows with it.
  std::optional<PlanePoint> distorted(PlanePoint point) const;
  /// What the lens shows at `point`; nullopt when it shows nothing there.
  std::optional<PlanePoint> undistorted(PlanePoint point) const;

 private:
  PlanePoint formula(PlanePoint point) const;

  Coefficients k_;
  double largest_radius_;
};

}  // namespace bole
