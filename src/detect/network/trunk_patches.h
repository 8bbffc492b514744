#pragma once

#include <array>
#include <cstdint>

#include "detect/contrast/bands.h"
#include "detect/contrast/trunk_shape.h"

namespace bole {

/// The picture about a trunk, in cells as small as pixels may be: what a convolutional network is
/// shown of a candidate that the features leave in doubt. Light, contrast and polarity are taken
/// out, and so is size, but not what surrounds the trunk.
struct TrunkPatches {
  static constexpr int kSide = 32;  ///< rows and columns of cells
  static constexpr int kCells = kSide * kSide;
  static constexpr int kUnits = 32;  ///< of a value: parts of the patch's standard deviation

  /// Row by row from the top: the log brightness less its mean, of a dark trunk, or its negative,
  /// of a bright one; cut off at 127 on either side.
  using Patch = std::array<std::int8_t, kCells>;
  Patch trunk;   ///< from where it is first seen to a width below its foot, two widths from its
                 ///< middle to each side, in the trunk's own coordinates: it stands upright
  Patch around;  ///< all the panorama's rows, six widths from its middle to each side, at least 40
                 ///< columns and at most 600 of 1440 a turn; upright as in the picture
};

/// How far to each side patches reach, columns: the margin that Bands needs for middles within the
/// panorama. `focal`: columns a radian.
int patch_reach(double focal);

/// Of a trunk whose middle lies within the panorama. `first_band` is the first that is seen of it.
TrunkPatches read_patches(const Bands& bands, const TrunkShape& shape, int first_band,
                          double focal);

}  // namespace bole
