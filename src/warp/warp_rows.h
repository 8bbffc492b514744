#pragma once

#include <cstdint>

#include "warp/warp_table.h"
#include "warp/warp_windows.h"

namespace bole {

/// One byte out of every pixel of an image: sample (row, column) is the byte at
/// row * stride + column * pixel_bytes + lead.
struct SampledImage {
  std::span<const std::byte> bytes;
  int stride = 0;       ///< bytes from a row to the next
  int pixel_bytes = 1;  ///< 1, 2 or 3
  int lead = 0;         ///< of a pixel's bytes, the one that is taken
};

/// Where panorama rows go: row i at pixels + (i - first) * stride, first being the first one asked
/// for. Whole tiles are written, so that stride is at least WarpTable::padded_width().
struct WarpOutput {
  std::uint8_t* pixels = nullptr;
  int stride = 0;
};

/// Un-warps rows [first, last); first is a multiple of kTileRows. The image has the table's size.
///
/// With p the four source samples of a pixel, u, v its position among them in steps and
/// s = (64 - v) ((64 - u) p00 + u p01) + v ((64 - u) p10 + u p11), bilinear interpolation times
/// 2^12:
/// (((s + 32) >> 6) + 32) >> 6. All kernels give equal bytes. `windows` are the table's own or
/// none; they are worth having where warp_uses_windows().
void warp_rows(const WarpTable& table, const WarpWindows& windows, const SampledImage& image,
               int first, int last, WarpOutput out);

/// Whether this processor has use for WarpWindows.
bool warp_uses_windows();

/// The same, one pixel after the other: what warp_rows is checked against.
void warp_rows_plain(const WarpTable& table, const SampledImage& image, int first, int last,
                     WarpOutput out);

/// The parts of one strip, for the kernels.
struct WarpStrip {
  const WarpTable& table;
  const WarpWindows& windows;
  const SampledImage& image;
  int strip;       ///< the panorama's rows from strip * kTileRows on
  int rows;        ///< how many of them, at most kTileRows
  WarpOutput out;  ///< of the first of them
};

/// Tile number `tile` of the strip, without its strays.
void warp_tile_plain(const WarpStrip& strip, int tile);
/// The strays of the strip.
void warp_strays(const WarpStrip& strip);

}  // namespace bole
