#pragma once

#include <array>

#include "detect/contrast/trunk_shape.h"
#include "geometry/panorama_view.h"

namespace bole {

/// The picture about a trunk's foot, in the trunk's own coordinates and finer than its features:
/// how wide the roots spread, what grows before them, and where the trunk ends.
struct FootPatch {
  static constexpr int kRows = 24;    ///< half a foot_unit apart, half of them above the foot
  static constexpr int kAcross = 10;  ///< strips a fifth of the trunk's width wide
  static constexpr int kCount = kRows * kAcross;

  /// Row by row from the top: log brightness less that of the trunk's core above its foot, over the
  /// patch's standard deviation; of a bright trunk its negative. Within 4 on either side.
  using Values = std::array<float, kCount>;
};

/// Beyond the borders the panorama goes on round the turn where it `wraps`, else by its outermost
/// pixels. log[i] is the log brightness of i / 4 grey levels, kLogLevels of them; `focal`:
/// columns a radian.
FootPatch::Values read_foot_patch(const PanoramaView& panorama, bool wraps, const float* log,
                                  const TrunkShape& shape, double focal);

}  // namespace bole
