#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace bole {

/// The inner loops of EdgeFitter, in whole vectors of whatever this processor has, and the plain
/// loops that say what they must give: equal results, sums of floats included, which are taken in
/// kEdgeLanes parts whatever the vectors' length.
inline constexpr int kEdgeLanes = 16;
inline constexpr int kMostEdgeBands = 80;

/// Bands of a panorama, as Bands keeps them, along an edge. `bend` at column x is
/// sum[x + flank] - 2 sum[x] + sum[x - flank]: `flank` times what is brighter to the right.
struct EdgeBands {
  const std::uint16_t* sums = nullptr;  ///< of the first band, at column 0
  std::ptrdiff_t pitch = 0;             ///< from a band's sums to the next's
  int count = 0;                        ///< at most kMostEdgeBands
  int horizon = 0;                      ///< the first of them below it
  float first_row = 0;                  ///< of the first band's middle, the edge's foot being row 0
  float row_step = 0;                   ///< rows a band
  int flank = 0;                        ///< columns of the means on either side

  std::int16_t bend(int band, int column) const {
    const std::uint16_t* at = sums + band * pitch + column;
    return static_cast<std::int16_t>(at[flank] - 2 * at[0] + at[-flank]);
  }
};

/// A straight edge: column + slope * row.
struct EdgeLine {
  float column = 0, slope = 0;
};

/// Sub-column places of an edge, band by band; weight 0 where it has none.
struct EdgePlaces {
  static constexpr int kReach = 3;  ///< columns beside the line that are looked at

  int count = 0;  ///< bands, rounded up to kEdgeLanes
  int found = 0;  ///< of them with a place
  alignas(64) std::array<float, kMostEdgeBands> row, column, weight;

  static int whole_groups(int bands) { return (bands + kEdgeLanes - 1) / kEdgeLanes * kEdgeLanes; }
};

/// Looks for the highest sign * bend (above the horizon of either sign) within kReach columns of
/// the line; it counts when it is at least `least` and not at the border. Its column is that of the
/// parabola through it and its neighbours, its weight min(bend / flank, strongest).
void place_edge(const EdgeBands& bands, EdgeLine line, int sign, int least, float strongest,
                EdgePlaces& places);
void place_edge_plain(const EdgeBands& bands, EdgeLine line, int sign, int least, float strongest,
                      EdgePlaces& places);

/// Sums over places of w = weight (1 - u^2)^2, u = error / tail, |u| < 1, and of w times row,
/// row^2, error, row error, error^2; the error is a place's column less the line's.
struct LineSums {
  float w = 0, row = 0, row_row = 0, error = 0, row_error = 0, error_error = 0;
};
LineSums sum_places(const EdgePlaces& places, EdgeLine line, float tail);
LineSums sum_places_plain(const EdgePlaces& places, EdgeLine line, float tail);

/// What two edges respond along their lines: r = bend / full for the right edge, -bend / full for
/// the left one, cut off at 1 on either side.
struct EdgeResponses {
  std::array<float, 2> below{};  ///< left, right: sums of r below the horizon
  std::array<float, 2> above{};  ///< sums of |r| above it
  int agree_below = 0;           ///< bands where both r are over 0.25
  int agree_above = 0;           ///< bands where both |r| are over 0.3
};
EdgeResponses respond_along(const EdgeBands& bands, EdgeLine left, EdgeLine right, float full);
EdgeResponses respond_along_plain(const EdgeBands& bands, EdgeLine left, EdgeLine right,
                                  float full);

/// What two edges say of a trunk, band by band: (l + r) / 4 + min(l, r) / 2 - 0.3 with the same
/// responses; above the horizon a response of the wrong sign counts kWrongSignAbove of one of the
/// right sign, and the value is 0.4 ((l + r) / 4 + min(l, r) / 2 - 0.5).
inline constexpr float kWrongSignAbove = -0.7F;
using BandValues = std::array<float, kMostEdgeBands>;
void join_edges(const EdgeBands& bands, EdgeLine left, EdgeLine right, float full,
                BandValues& values);
void join_edges_plain(const EdgeBands& bands, EdgeLine left, EdgeLine right, float full,
                      BandValues& values);

}  // namespace bole
