#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace bole {

/// The inner loops of FeatureReader's grid, in whole vectors of whatever this processor has, and
/// the plain loops that say what they must give: equal results.
inline constexpr int kGridHeights = 11;
inline constexpr int kGridAcross = 12;
inline constexpr int kGridLanes = 16;
inline constexpr int kMostGridBands = 256;
inline constexpr int kGridLookahead = 128;  ///< sums that may be read from the first border on

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
  /// What the sums in cell i are multiplied by; 0 from kGridAcross on.
  alignas(64) std::array<float, kGridLanes> factors{};
};

/// Where cells of one height begin and end: so many bands from the first one, and a share of the
/// next.
struct CellRows {
  int from = 0, to = 0;  ///< below `bands`
  float from_rest = 0, to_rest = 0;
  float factor = 0;  ///< what the sums are multiplied by
};

/// The mean of the values of all cells, and the standard deviation about it.
struct GridStatistics {
  float mean = 0, spread = 0;
};

/// values[h][i] = kCellParts times the sum of the log brightness in cell i over the rows h, times
/// both factors. Brightness goes evenly within a band and within a column; in a column it is
/// counted in parts of 1 / kCellParts, rounded to the nearest.
inline constexpr int kCellParts = 16;
using GridValues = std::array<std::array<float, kGridLanes>, kGridHeights>;
GridStatistics read_cells(const CellColumns& columns,
                          const std::array<CellRows, kGridHeights>& rows, GridValues& values);
GridStatistics read_cells_plain(const CellColumns& columns,
                                const std::array<CellRows, kGridHeights>& rows, GridValues& values);

}  // namespace bole
