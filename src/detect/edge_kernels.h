#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace bole {

/// The inner loop of EdgeFitter's search: an edge's contrast summed along lines of several slopes.
struct EdgeWindow {
  static constexpr int kColumns = 64;  ///< that are looked at
  static constexpr int kPlaces = 32;   ///< at which a line may stand: the middle ones
  static constexpr int kSlopes = 9;
  static constexpr int kMostBands = 80;

  const std::int32_t* sums = nullptr;  ///< of the first band, at the window's first column
  std::ptrdiff_t pitch = 0;            ///< from a band's sums to the next's
  int bands = 0;                       ///< at most kMostBands
  int horizon = 0;                     ///< the first of them below it
  int flank = 0;                       ///< columns of the means on either side
  int sign = 1;                        ///< of the looked-for edge: 1 brightens to the right
  int limit = 0;                       ///< of a band's response, log brightness as in Bands
  /// Where in the window a slope's line of places starts, for each band.
  const std::array<std::array<std::uint8_t, kSlopes>, kMostBands>* starts = nullptr;
};
using EdgeTotals = std::array<std::array<std::int16_t, EdgeWindow::kPlaces>, EdgeWindow::kSlopes>;

/// totals[s][i] = sum over the bands of the response at window column starts[band][s] + i: the mean
/// to the right less the mean to the left, times sign, cut off at the limit; above the horizon a
/// response of the wrong sign counts 11 / 16 of one of the right sign, rounded down.
void sum_edges(const EdgeWindow& window, EdgeTotals& totals);
void sum_edges_plain(const EdgeWindow& window, EdgeTotals& totals);

}  // namespace bole
