#pragma once

#include <array>

#include "detect/network/trunk_features.h"

namespace bole {

/// What makes every row of a candidate's cells as strong in contrast as the others, so that a trunk
/// before pale ground shows its edges there although the sky above outshines all; and what says how
/// strong they were: in whole vectors of whatever this processor has, and a plain loop that says
/// what they must give. `unit` is the unit of cells and strips, log brightness.
struct RowLevels {
  static constexpr int kLanes = 16;  ///< rows, and some more for whole vectors
  std::array<float, kLanes> mean, full;
};

/// Of kHeights x kAcross cells. To `out` go TrunkFeatures::kRowContrasts values, for each row
/// unless said otherwise: mean, in units of `unit`; log of its spread; contrast of the left edge
/// without its sign; of the right; the lesser of the two; their product, positive where both have
/// one sign; spread within the trunk; then for each two neighbouring rows the step of the trunk's
/// own brightness.
RowLevels row_contrasts(float unit, const float* grid, float* out);
RowLevels row_contrasts_plain(float unit, const float* grid, float* out);

/// Makes the rows alike, in place.
void even_rows(const RowLevels& levels, float* grid);

/// The same for all lines about the foot together: kFootRows x kStrips strips. Returns the log of
/// their spread.
float even_foot(float unit, float* foot);

}  // namespace bole
