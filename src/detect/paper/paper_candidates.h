#pragma once

#include <span>
#include <vector>

#include "detect/paper/paper_templates.h"

namespace bole {

/// A column at which one of the templates has a local minimum.
struct PaperCandidate {
  int column = 0;
  int index = 0;    ///< of the template
  float score = 0;  ///< S there
};

/// Appends the local minima of `scores` below `threshold`; of a plateau its first column. The
/// columns go round where `wraps`; else the outermost ones have one neighbour.
void append_minima(std::span<const float> scores, float threshold, bool wraps, int index,
                   std::vector<PaperCandidate>& candidates);

/// Non-maximum suppression, best (lowest) first: a candidate goes when its centre lies within the
/// rectangle of a better one, or the better one's within its own. First along the row, among
/// candidates of one depth, then down the column, among those of all depths that are left. `width`:
/// of the panorama, 0 when it does not wrap. Leaves the candidates best first.
void suppress(const std::vector<PaperTemplate>& templates, int width,
              std::vector<PaperCandidate>& candidates);

}  // namespace bole
