#pragma once

#include <array>
#include <cstdint>

namespace bole {

/// The inner loops of read_patches, in whole vectors of whatever this processor has, and the plain
/// loops that say what they must give: equal results.
inline constexpr int kPatchSide = 32;
inline constexpr int kPatchParts = 16;  ///< of a column, that borders of cells lie at

/// Borders of kPatchSide cells across one band.
struct PatchColumns {
  float first = 0, cell = 0;  ///< column of the first border, and from one to the next
  int least = 0, last = 0;    ///< borders are kept within these columns, last + 1 is read, too
};

/// Adds to cells[i] kPatchParts times the sum of the log brightness between border i and the next,
/// each at the nearest part of a column. `sums` are those of a band, at column 0, read two at a
/// time as a little-endian number; no cell is wider than Bands::kMostColumns.
void add_cells(const std::uint16_t* sums, const PatchColumns& columns, std::int32_t* cells);
void add_cells_plain(const std::uint16_t* sums, const PatchColumns& columns, std::int32_t* cells);

/// Rows of cells, and what each row is to be multiplied by so that it is log brightness in units of
/// 1 / kLevels.
struct PatchCells {
  static constexpr int kLevels = 1024;
  alignas(64) std::array<std::array<std::int32_t, kPatchSide>, kPatchSide> sums{};
  std::array<float, kPatchSide> factors{};
};

/// out = the cells' levels, rounded down, less their mean (rounded down), times `factor` over their
/// standard deviation or, where that is less, over `least_spread` (of log brightness); to the
/// nearest, within 127 on either side.
void standardise_cells(const PatchCells& cells, float factor, float least_spread, std::int8_t* out);
void standardise_cells_plain(const PatchCells& cells, float factor, float least_spread,
                             std::int8_t* out);

}  // namespace bole
