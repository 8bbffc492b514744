#pragma once

#include "detect/trunk_features.h"

namespace bole {

/// Makes every row of a candidate's cells, and the lines about its foot, as strong in contrast as
/// the others, so that a trunk before pale ground shows its edges there although the sky above
/// outshines all; and says how strong they were.
///
/// `grid` holds kHeights x kAcross cells, `foot` kFootRows x kStrips strips, both in units of
/// `unit`, log brightness; both are changed in place. Of `out` TrunkFeatures::kRowContrasts values
/// are written, for each row unless said otherwise: mean, in units of `unit`; log of its spread;
/// contrast of the left edge without its sign; of the right; the lesser of the two; their product,
/// positive where both have one sign; spread within the trunk; then for each two neighbouring rows
/// the step of the trunk's own brightness; then the log of the foot lines' spread.
void even_contrasts(float unit, float* grid, float* foot, float* out);

}  // namespace bole
