#include "warp/warp_windows.h"

#include <algorithm>
#include <optional>

namespace bole {
namespace {

struct Place {
  int row, column;
};

Place place_of(const WarpTile& tile, WarpEntry entry) {
  return {tile.row + static_cast<int>(entry >> (16 + kWarpBits)),
          tile.column + static_cast<int>((entry & 0xffff) >> kWarpBits)};
}

// Columns [first, last) of a tile, within one of its halves.
struct Columns {
  int first, last;
};

// Calls visit(pixel of the half, where its source is).
template <class Visit>
void for_each_source(const WarpTile& tile, const WarpEntry* entries, Columns columns, Visit visit) {
  for (int row = 0; row < kTileRows; ++row) {
    for (int column = columns.first; column < columns.last; ++column) {
      const int pixel = row * WarpWindow::kColumns + column % WarpWindow::kColumns;
      const WarpEntry entry = entries[row * kTileColumns + column];
      visit(static_cast<std::size_t>(pixel), entry, place_of(tile, entry));
    }
  }
}

// A window that holds all sources of these columns; none where they lie too far apart.
std::optional<WarpWindows::Origin> window_about(const WarpTile& tile, const WarpEntry* entries,
                                                Columns columns, ImageSize size, int side) {
  Place first{size.height - side, size.width - side}, last{0, 0};
  for_each_source(tile, entries, columns, [&](std::size_t, WarpEntry, Place place) {
    first = {std::min(first.row, place.row), std::min(first.column, place.column)};
    last = {std::max(last.row, place.row), std::max(last.column, place.column)};
  });
  if (first.row < 0 || first.column < 0 || last.row + 1 >= first.row + side ||
      last.column + 1 >= first.column + side) {
    return std::nullopt;
  }
  return WarpWindows::Origin{static_cast<std::uint16_t>(first.row),
                             static_cast<std::uint16_t>(first.column)};
}

void fill(const WarpTile& tile, const WarpEntry* entries, Columns columns,
          WarpWindows::Origin origin, int side, WarpWindow& window) {
  for_each_source(tile, entries, columns, [&](std::size_t pixel, WarpEntry entry, Place place) {
    window.place[pixel] =
        static_cast<std::uint8_t>(side * (place.row - origin.row) + place.column - origin.column);
    window.column_step[pixel] = static_cast<std::uint8_t>(entry % kWarpSteps);
    window.row_step[pixel] = static_cast<std::uint8_t>((entry >> 16) % kWarpSteps);
  });
}

// Fills `window` for the columns from `start` on; nothing when two windows do not suffice.
std::optional<WarpWindows::Half> fill_half(const WarpTile& tile, const WarpEntry* entries,
                                           int start, ImageSize size, WarpWindow& window) {
  constexpr int kSmall = WarpWindow::kSmallSide, kSide = WarpWindow::kSide;
  const int middle = start + WarpWindow::kColumns / 2, end = start + WarpWindow::kColumns;
  const Columns both{start, end};
  if (const auto small = window_about(tile, entries, both, size, kSmall)) {
    fill(tile, entries, both, *small, kSmall, window);
    return WarpWindows::Half{*small, *small, true};
  }
  const auto whole = window_about(tile, entries, both, size, kSide);
  const auto left = whole ? whole : window_about(tile, entries, {start, middle}, size, kSide);
  const auto right = whole ? whole : window_about(tile, entries, {middle, end}, size, kSide);
  if (!left || !right) return std::nullopt;
  fill(tile, entries, {start, middle}, *left, kSide, window);
  fill(tile, entries, {middle, end}, *right, kSide, window);
  return WarpWindows::Half{*left, *right};
}

}  // namespace

WarpWindows::WarpWindows(const WarpTable& table)
    : tiles_(table.tiles().size()), windows_(2 * table.tiles().size()) {
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    tiles_[t].fits = true;
    for (std::size_t h = 0; h < 2; ++h) {
      const auto half = fill_half(table.tiles()[t], &table.entries()[t * kTilePixels],
                                  static_cast<int>(h) * WarpWindow::kColumns, table.image_size(),
                                  windows_[2 * t + h]);
      tiles_[t].fits = tiles_[t].fits && half;
      tiles_[t].halves[h] = half.value_or(Half{});
    }
  }
}

}  // namespace bole
