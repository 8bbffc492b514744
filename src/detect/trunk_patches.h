#pragma once

#include <array>
#include <cstdint>

#include "detect/bands.h"
#include "detect/trunk_shape.h"

namespace bole {

/// The picture about a trunk, in cells as small as pixels may be: what a convolutional network is
/// shown of a candidate that the features leave in doubt. Light, contrast and polarity are taken
/// out, and so is size, but not what surrounds the trunk.
struct TrunkPatches {
  static constexpr int kSide = 32;  ///< rows and columns of cells
  static constexpr int kCells = kSide * kSide;
  static constexpr int kUnits = 32;  ///< of a value: parts of the patch's standard deviation

  using Patch = std::array<std::int8_t, kCells>;
  Patch trunk;   ///< from where it is first seen to a width below its foot, two widths to each
                 ///< side, in the trunk's own coordinates: its middle stands upright
  Patch around;  ///< all the panorama's rows, six widths to each side, upright as in the picture
};

/// `first_band` is the first that is seen of the trunk.
TrunkPatches read_patches(const Bands& bands, const TrunkShape& shape, int first_band,
                          double focal);

}  // namespace bole
