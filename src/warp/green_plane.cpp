#include "warp/green_plane.h"

#include <algorithm>

namespace bole {
namespace {

// Green stands first in the rows of that parity: 0 for GRBG and GBRG, 1 for RGGB and BGGR.
int parity_of_rows_that_begin_green(PixelFormat format) {
  return format == PixelFormat::grbg || format == PixelFormat::gbrg ? 0 : 1;
}

struct Rows {  // of the image; at its border the one inside stands for the one outside
  const std::uint8_t *above, *here, *below;
};

std::uint8_t mean_of_neighbours(const Rows& rows, int column, int width) {
  const int left = column > 0 ? column - 1 : column + 1;
  const int right = column + 1 < width ? column + 1 : column - 1;
  return static_cast<std::uint8_t>(
      (rows.above[column] + rows.below[column] + rows.here[left] + rows.here[right] + 2) / 4);
}

}  // namespace

void complete_bayer_green(const ImageView& image, std::vector<std::uint8_t>& green) {
  const auto [width, height] = image.size;
  green.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const auto* const pixels = reinterpret_cast<const std::uint8_t*>(image.planes[0].bytes.data());
  const auto row = [&](int i) {
    return pixels + static_cast<std::ptrdiff_t>(i) * image.planes[0].stride;
  };
  const int green_first = parity_of_rows_that_begin_green(image.format);
  for (int i = 0; i < height; ++i) {
    const Rows rows{row(i > 0 ? i - 1 : 1), row(i), row(i + 1 < height ? i + 1 : i - 1)};
    std::uint8_t* const out = &green[static_cast<std::size_t>(i) * static_cast<std::size_t>(width)];
    std::copy_n(rows.here, width, out);
    for (int j = i % 2 == green_first ? 1 : 0; j < width; j += 2) {
      out[j] = mean_of_neighbours(rows, j, width);
    }
  }
}

}  // namespace bole
