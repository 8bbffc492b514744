#include "warp/green_plane.h"

namespace bole {
namespace {

// Green stands first in the rows of that parity: 0 for GRBG and GBRG, 1 for RGGB and BGGR.
int parity_of_rows_that_begin_green(PixelFormat format) {
  return format == PixelFormat::grbg || format == PixelFormat::gbrg ? 0 : 1;
}

struct Rows {  // of the image; at its border the one inside stands for the one outside
  const std::uint8_t *above, *here, *below;
};

std::uint8_t mean_of_neighbours(const Rows& rows, int column, int left, int right) {
  return static_cast<std::uint8_t>(
      (rows.above[column] + rows.below[column] + rows.here[left] + rows.here[right] + 2) / 4);
}

// `first`: the first column that is not green. The mean is taken everywhere and used at every other
// column: without branches the compiler makes vectors of it.
void complete_row(const Rows& rows, int first, int width, std::uint8_t* out) {
  for (int j = 1; j + 1 < width; ++j) {
    const std::uint8_t here = rows.here[j], mean = mean_of_neighbours(rows, j, j - 1, j + 1);
    out[j] = ((j ^ first) & 1) == 0 ? mean : here;
  }
  const int last = width - 1;
  out[0] = first == 0 ? mean_of_neighbours(rows, 0, 1, 1) : rows.here[0];
  out[last] =
      last % 2 == first ? mean_of_neighbours(rows, last, last - 1, last - 1) : rows.here[last];
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
    complete_row(rows, i % 2 == green_first ? 1 : 0, width,
                 &green[static_cast<std::size_t>(i) * static_cast<std::size_t>(width)]);
  }
}

}  // namespace bole
