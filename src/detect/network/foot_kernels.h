#pragma once

#include <array>

#include "geometry/panorama_view.h"

namespace bole {

/// Entries of a table of log brightness by quarters of a grey level: enough for 255 and a little.
inline constexpr int kLogLevels = 1024;

/// The inner loops of FeatureReader about a trunk's foot, in whole vectors of whatever this
/// processor has, and the plain loops that say what they must give: equal results.

/// Where a trunk ends. Columns and rows are continuous, as in TrunkShape.
struct FootPlace {
  float row = 0;     ///< of the foot
  float middle = 0;  ///< column there
  float lean = 0;    ///< columns a row
  float width = 0;   ///< columns
  float unit = 0;    ///< rows between lines
};

/// Lines across the trunk, kLines / 2 of them above its foot, each of three strips: left of the
/// trunk, its core, right of it.
struct FootLines {
  static constexpr int kLines = 16, kStrips = 3;
  /// Mean log brightness by strip and line: of the two rows nearest to the line, each mean rounded
  /// down to a quarter grey level before the logarithm.
  alignas(64) std::array<std::array<float, kLines>, kStrips> at;
};

/// Beyond the borders the panorama goes on round the turn where it `wraps`, else by its outermost
/// pixels. log[i] is the log brightness of i / 4 grey levels.
void read_foot_lines(const PanoramaView& panorama, bool wraps, const float* log,
                     const FootPlace& place, FootLines& lines);
void read_foot_lines_plain(const PanoramaView& panorama, bool wraps, const float* log,
                           const FootPlace& place, FootLines& lines);

}  // namespace bole
