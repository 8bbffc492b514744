#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "warp/warp_table.h"

namespace bole {

/// The sources of half a tile, eight by eight panorama pixels, that lie in a window of 8 x 8 or
/// 16 x 16 source pixels, or in two of the latter, one for the left four columns and one for the
/// right four. A processor that can look bytes up in 64 or 256 of them at once (see warp_rows.cpp)
/// reads a window once and picks all pixels out of it.
struct alignas(64) WarpWindow {
  static constexpr int kSmallSide = 8, kSide = 16;  ///< of the window, source pixels
  static constexpr int kColumns = 8;                ///< of the half tile
  static constexpr int kPixels = kTileRows * kColumns;

  /// Of each pixel, row by row: the first of its four source samples, side row + column within the
  /// window, and how far from it the source lies, in steps.
  std::array<std::uint8_t, kPixels> place, column_step, row_step;
};

/// A table's tiles as windows, where they fit in such. It takes three quarters of the bytes of the
/// table's own entries.
class WarpWindows {
 public:
  /// None.
  WarpWindows() = default;
  explicit WarpWindows(const WarpTable& table);

  struct Origin {
    std::uint16_t row = 0, column = 0;
    friend bool operator==(const Origin&, const Origin&) = default;
  };
  struct Half {
    Origin left, right;  ///< of the windows; the same where one is enough
    bool small = false;  ///< one window of the smaller side
  };
  struct Tile {
    bool fits = false;
    std::array<Half, 2> halves{};  ///< the left one first
  };

  bool empty() const { return tiles_.empty(); }
  const Tile& tile(std::size_t number) const { return tiles_[number]; }
  /// The two halves of a tile that fits.
  const WarpWindow* windows(std::size_t number) const { return &windows_[2 * number]; }

 private:
  std::vector<Tile> tiles_;
  std::vector<WarpWindow> windows_;
};

}  // namespace bole
