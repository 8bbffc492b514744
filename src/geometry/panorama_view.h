#pragma once

#include <cstdint>
#include <span>

#include "geometry/panorama.h"

namespace bole {

/// The rows of one panorama column between which the camera sees anything: [first, last). Empty
/// where it sees nothing. Rows inside may still be masked.
struct SeenRows {
  std::uint16_t first = 0;
  std::uint16_t last = 0;
  bool empty() const { return first >= last; }
};

/// What of a panorama the camera can see, the same for every frame. A pixel that is not seen holds
/// the value of the nearest seen pixel of its column (the upper one where two are as near).
struct SeenMap {
  std::span<const std::uint8_t> pixels;  ///< rows x width, 1 = seen, 0 = masked or outside
  std::span<const SeenRows> columns;     ///< width
};

/// The green plane of an un-warped frame, in memory that somebody else owns.
struct PanoramaView {
  const PanoramaGeometry* geometry = nullptr;
  const std::uint8_t* pixels = nullptr;  ///< rows x stride, the first `width` of each row are used
  int stride = 0;                        ///< bytes from a row to the next, at least width

  const std::uint8_t* row(int i) const { return pixels + static_cast<std::ptrdiff_t>(i) * stride; }
};

}  // namespace bole
