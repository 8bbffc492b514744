#include <algorithm>

#include "warp/warp_rows.h"

namespace bole {
namespace {

struct Source {
  int row, column;
  unsigned row_step, column_step;
};

std::uint8_t interpolate(const SampledImage& image, const Source& source) {
  const auto sample = [&](int row, int column) {
    const auto at =
        static_cast<std::size_t>(source.row + row) * static_cast<std::size_t>(image.stride) +
        static_cast<std::size_t>((source.column + column) * image.pixel_bytes + image.lead);
    return std::to_integer<unsigned>(image.bytes[at]);
  };
  const unsigned u = source.column_step, v = source.row_step;
  const unsigned top = (kWarpSteps - u) * sample(0, 0) + u * sample(0, 1);
  const unsigned bottom = (kWarpSteps - u) * sample(1, 0) + u * sample(1, 1);
  const unsigned sum = (kWarpSteps - v) * top + v * bottom;
  constexpr unsigned kHalf = kWarpSteps / 2;
  return static_cast<std::uint8_t>((((sum + kHalf) >> kWarpBits) + kHalf) >> kWarpBits);
}

Source source_of(const WarpTile& tile, WarpEntry entry) {
  return {.row = tile.row + static_cast<int>(entry >> (16 + kWarpBits)),
          .column = tile.column + static_cast<int>((entry & 0xffff) >> kWarpBits),
          .row_step = (entry >> 16) % kWarpSteps,
          .column_step = entry % kWarpSteps};
}

}  // namespace

void warp_tile_plain(const WarpStrip& strip, int tile) {
  const std::size_t number = strip.strip * strip.table.tiles_per_strip() + tile;
  const WarpEntry* entry = &strip.table.entries()[number * kTilePixels];
  for (int i = 0; i < strip.rows; ++i) {
    std::uint8_t* const out = strip.out.pixels + std::ptrdiff_t{i} * strip.out.stride +
                              std::ptrdiff_t{tile} * kTileColumns;
    for (int j = 0; j < kTileColumns; ++j) {
      out[j] = interpolate(strip.image, source_of(strip.table.tiles()[number], *entry++));
    }
  }
}

void warp_strays(const WarpStrip& strip) {
  const int tiles = strip.table.tiles_per_strip();
  const auto first_tile = static_cast<std::uint32_t>(strip.strip * tiles);
  auto stray = std::ranges::lower_bound(strip.table.strays(), first_tile, {}, &WarpStray::tile);
  for (; stray != strip.table.strays().end() && stray->tile < first_tile + tiles; ++stray) {
    const int row = stray->pixel / kTileColumns;
    if (row >= strip.rows) continue;
    const auto column = static_cast<std::ptrdiff_t>(stray->tile - first_tile) * kTileColumns +
                        stray->pixel % kTileColumns;
    strip.out.pixels[static_cast<std::ptrdiff_t>(row) * strip.out.stride + column] =
        interpolate(strip.image, {stray->row, stray->column, stray->row_step, stray->column_step});
  }
}

}  // namespace bole
