#pragma once

#include <limits>

namespace bole {

/// The probability that there is a tree, given all that has been seen of it.
///
/// The detector's log odds of one tree waver with what it stands before and with the light, and so
/// do those of a rock that looks like a tree; frames that follow each other waver alike, so that
/// many doubtful ones say little more than one. What counts is this frame's log odds l, the highest
/// that there ever were, in what share of the frames since the first it was seen, and whether the
/// places seen along the robot's way are those of one thing that stands still, which shows in how
/// well its range is known:
///   log odds = shift + now * l + best * max(l) + steady * log(seen) + known * log(range /
///   range_sigma).
/// The constants are what `scripts/tracking FOLDER --fit` finds on drives.
class TrackScore {
 public:
  /// Takes in the score that the detector gives in this frame. Answers the probability given this
  /// frame and those before. `seen`: the share of the frames from the first sighting to this one
  /// that showed it. `range_share`: range_sigma / range as now known.
  float update(float score, double seen, double range_share);

 private:
  double best_ = -std::numeric_limits<double>::infinity();
};

}  // namespace bole
