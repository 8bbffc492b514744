#include "detect/contrast/veil.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace bole {
namespace {

constexpr int kStep = 8;          // rows and columns
constexpr int kDarkest = 500;     // one pixel of so many is darker than what tells the veil
constexpr int kClear = 40;        // grey levels, of that pixel in a clear picture
constexpr int kThickerParts = 5;  // one part more than that: it was darker than kClear before
constexpr int kLeft = 8;          // grey levels that no veil takes

}  // namespace

int veil_over(const PanoramaView& panorama, const SeenMap& seen) {
  const int rows = panorama.geometry->rows, width = panorama.geometry->width;
  std::array<int, 256> histogram{};
  int pixels = 0;
  for (int row = 0; row < rows; row += kStep) {
    const std::uint8_t* const at = panorama.row(row);
    const std::uint8_t* const is_seen = seen.pixels.data() + static_cast<std::size_t>(row) * width;
    for (int x = 0; x < width; x += kStep) {
      histogram[at[x]] += is_seen[x];
      pixels += is_seen[x];
    }
  }
  int darker = 0, level = 0;
  while (level < 255 && (darker += histogram[level]) <= pixels / kDarkest) ++level;
  const int above = level - kClear;
  return std::clamp(4 * std::min(above + above / kThickerParts, level - kLeft), 0, kThickestVeil);
}

}  // namespace bole
