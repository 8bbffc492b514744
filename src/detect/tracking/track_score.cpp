#include "detect/tracking/track_score.h"

#include <algorithm>
#include <cmath>

#include "detect/log_odds.h"

namespace bole {
namespace {

constexpr double kShift = -2.86, kNow = 0.29, kBest = 0.90, kSteady = 3.56, kKnown = 1.20;

}  // namespace

float TrackScore::update(float score, double seen, double range_share) {
  const double now = log_odds(score);
  best_ = std::max(best_, now);
  const double odds = kShift + kNow * now + kBest * best_ + kSteady * std::log(seen) -
                      kKnown * std::log(range_share);
  return probability(odds);
}

}  // namespace bole
