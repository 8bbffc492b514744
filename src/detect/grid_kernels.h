#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace bole {

/// The inner loops of FeatureReader's grid, in whole vectors of whatever this processor has, and
/// the plain loops that say what they must give.
inline constexpr int kGridLanes = 16;
inline constexpr int kMostGridBands = 256;

/// Columns of cells that lean over the bands of a panorama.
struct CellColumns {
  const std::uint16_t* sums = nullptr;   ///< of the first band, at column 0, as in Bands
  std::ptrdiff_t pitch = 0;              ///< from a band's sums to the next's
  const std::int32_t* coarse = nullptr;  ///< of the first band, at column -margin, as in Bands;
                                         ///< none where no cell is wider than kMostColumns
  std::ptrdiff_t coarse_pitch = 0;
  int margin = 0;
  int bands = 0;     ///< at most kMostGridBands
  float middle = 0;  ///< column, in the first band
  float lean = 0;    ///< columns a band
  /// From the middle, columns; ascending. Cell i lies between the borders i and i + 1.
  alignas(64) std::array<float, kGridLanes> borders{};
};

/// sums[b][i] = 16 times the log brightness in cell i of the bands before b; within a column,
/// brightness goes evenly, in parts of 1/16 rounded to the nearest.
struct CellSums {
  static constexpr int kParts = 16;
  alignas(64) std::int32_t at[kMostGridBands + 1][kGridLanes];
};
void sum_cells(const CellColumns& cells, CellSums& sums);
void sum_cells_plain(const CellColumns& cells, CellSums& sums);

}  // namespace bole
