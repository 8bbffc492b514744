#include "detect/tracking/track_score.h"

#include <algorithm>
#include <cmath>

namespace bole {
namespace {

constexpr double kShift = -2.86, kNow = 0.29, kBest = 0.90, kSteady = 3.56, kKnown = 1.20;

}  // namespace

double log_odds(double probability) {
  constexpr double kCertain = 1e-4;
  probability = std::clamp(probability, kCertain, 1 - kCertain);
  return std::log(probability / (1 - probability));
}

float TrackScore::update(float score, double seen, double range_share) {
  const double now = log_odds(score);
  best_ = std::max(best_, now);
  const double odds = kShift + kNow * now + kBest * best_ + kSteady * std::log(seen) -
                      kKnown * std::log(range_share);
  return static_cast<float>(1 / (1 + std::exp(-odds)));
}

}  // namespace bole
