#include "warp/warp_windows.h"

#include <algorithm>

namespace bole {
namespace {

constexpr int kSide = WarpWindow::kSide;

struct Place {
  int row, column;
};

Place place_of(const WarpTile& tile, WarpEntry entry) {
  return {tile.row + static_cast<int>(entry >> (16 + kWarpBits)),
          tile.column + static_cast<int>((entry & 0xffff) >> kWarpBits)};
}

// Calls visit(pixel of the half, entry).
template <class Visit>
void for_each_pixel(const WarpEntry* entries, int half, Visit visit) {
  for (int pixel = 0; pixel < WarpWindow::kPixels; ++pixel) {
    const int row = pixel / WarpWindow::kColumns, column = pixel % WarpWindow::kColumns;
    visit(static_cast<std::size_t>(pixel),
          entries[row * kTileColumns + half * WarpWindow::kColumns + column]);
  }
}

// Fills `window`; false when the sources lie too far apart.
bool fill(const WarpTile& tile, const WarpEntry* entries, int half, ImageSize size,
          WarpWindows::Origin& origin, WarpWindow& window) {
  Place first{size.height - kSide, size.width - kSide}, last{0, 0};
  for_each_pixel(entries, half, [&](std::size_t, WarpEntry entry) {
    const Place place = place_of(tile, entry);
    first = {std::min(first.row, place.row), std::min(first.column, place.column)};
    last = {std::max(last.row, place.row), std::max(last.column, place.column)};
  });
  if (first.row < 0 || first.column < 0 || last.row + 1 >= first.row + kSide ||
      last.column + 1 >= first.column + kSide) {
    return false;
  }
  origin = {static_cast<std::uint16_t>(first.row), static_cast<std::uint16_t>(first.column)};
  for_each_pixel(entries, half, [&](std::size_t pixel, WarpEntry entry) {
    const Place place = place_of(tile, entry);
    window.place[pixel] =
        static_cast<std::uint8_t>(kSide * (place.row - first.row) + place.column - first.column);
    window.column_step[pixel] = static_cast<std::uint8_t>(entry % kWarpSteps);
    window.row_step[pixel] = static_cast<std::uint8_t>((entry >> 16) % kWarpSteps);
  });
  return true;
}

}  // namespace

WarpWindows::WarpWindows(const WarpTable& table)
    : tiles_(table.tiles().size()), windows_(2 * table.tiles().size()) {
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    const auto fits = [&](int half) {
      const auto h = static_cast<std::size_t>(half);
      return fill(table.tiles()[t], &table.entries()[t * kTilePixels], half, table.image_size(),
                  tiles_[t].origins[h], windows_[2 * t + h]);
    };
    tiles_[t].fits = fits(0) && fits(1);
  }
}

}  // namespace bole
