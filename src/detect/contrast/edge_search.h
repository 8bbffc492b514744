#pragma once

#include "detect/contrast/edge_kernels.h"

namespace bole {

/// Where an edge is looked for: lines of kSlopes slopes through kPlaces places at the foot.
struct EdgeSearch {
  static constexpr int kColumns = 64;    ///< that are looked at
  static constexpr int kPlaces = 32;     ///< at which a line may stand: the middle ones
  static constexpr int kSlopes = 11;     ///< the middle one is upright
  static constexpr int kSlopeStep = 20;  ///< thousandths of a column a row, from slope to slope

  int first_column = 0;  ///< of the kColumns
  int reach = 0;         ///< at most kPlaces / 2: places left and right of the middle one
  int foot = 0;          ///< bands from the first one to the foot, at least those searched
  int sign = 1;          ///< of the looked-for edge: 1 brightens to the right
  int limit = 0;         ///< of a band's response, log brightness as in Bands
};
struct FoundEdge {
  int slope = 0, place = 0;
  friend bool operator==(const FoundEdge&, const FoundEdge&) = default;
};

/// The line along which the responses sum to the most; a place o off the middle counts 1 - 3 o /
/// 100 of it. In each band a line stands at the nearest whole column, at most (kColumns - kPlaces)
/// / 2 from where it ends. A response is sign * bend / flank, cut off at the limit and rounded to
/// the nearest; above the horizon one of the wrong sign counts 11 / 16 of one of the right sign,
/// rounded to the nearest. Of equals the first slope, then the first place.
FoundEdge find_edge(const EdgeBands& bands, const EdgeSearch& search);
FoundEdge find_edge_plain(const EdgeBands& bands, const EdgeSearch& search);

}  // namespace bole
