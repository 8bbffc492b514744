#pragma once

namespace bole {

/// The probability that there is a tree, given all that has been seen of it.
///
/// The detector's log odds of one tree waver about a level that is the tree's own, and so do those
/// of a rock that looks like one; frames that follow each other waver alike. So what counts beside
/// this frame's log odds is the level of those before, as far as it can be known from their number:
///   log odds = shift + now * l + before * sum(w l) / (doubt + sum(w)),
/// the sums over the earlier sightings, w falling with their age. The constants are what
/// `scripts/tracking FOLDER --fit` finds on drives.
class TrackScore {
 public:
  /// Takes in the score that the detector gives in this frame, `elapsed` seconds after the last
  /// call. Answers the probability given this frame and those before.
  float update(float score, double elapsed);

  /// Number of sightings, the old ones fading.
  double sightings() const { return weight_; }

  /// Of the log odds, as far as the sightings tell it; 0 before the first.
  double level() const;

 private:
  double sum_ = 0, weight_ = 0;
};

}  // namespace bole
