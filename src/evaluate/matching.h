#pragma once

#include <optional>
#include <span>
#include <vector>

#include "detect/tree.h"
#include "evaluate/truth.h"

namespace bole {

/// Frames with metric truth are judged on these trees: range in [1, 8] m, diameter in [0.2, 0.8] m,
/// half of it or more visible. Other marked trees neither help nor hurt.
bool eligible(const TruthTree& tree);

/// What became of one detection.
struct Match {
  enum class Verdict { hit, false_alarm, ignored };
  Verdict verdict = Verdict::ignored;
  const Tree* tree = nullptr;        ///< into the detections
  const TruthTree* truth = nullptr;  ///< into the truth; none for what matches nothing
  double error = 0;  ///< metres in position, or radians where only bearings are known
};

/// A marked trunk within the gate of a detection: |bearing error| <= max(1.5 degrees, half the
/// trunk's angular width), and on metric frames position error <= max(1 m, range / 4). Answers the
/// error in position, of frames that are not metric that in bearing.
std::optional<double> gated_error(const TruthTree& truth, const Tree& tree, bool metric);

/// Matches the detections of one frame to its trees as tools/score.py does: best score first, to
/// the nearest tree within the gate, an eligible one before others, each tree once. A detection
/// that matches nothing is ignored outside 1 to 8 m of metric frames and in frames that are not
/// exhaustive. In the order of falling scores.
std::vector<Match> match_frame(const TruthFrame& truth, std::span<const Tree> trees);

/// Trees of the frame that should be found.
int count_wanted(const TruthFrame& frame);

/// A(T & D)^2 / (A(T) A(D)) of the trunk's and the detection's rectangles in the panorama, from the
/// base up to +25 degrees (rows go with the tangent of the elevation).
double trunk_overlap(const TruthTree& truth, const Tree& tree, double height);

}  // namespace bole
