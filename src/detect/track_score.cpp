#include "detect/track_score.h"

#include <algorithm>
#include <cmath>

namespace bole {
namespace {

constexpr double kMemory = 2;    // seconds in which a sighting's weight falls to 1 / e
constexpr double kDoubt = 0.25;  // sightings
constexpr double kShift = 0.25, kNow = 0.99, kBefore = 0.78;

double log_odds(double probability) {
  constexpr double kCertain = 1e-4;
  probability = std::clamp(probability, kCertain, 1 - kCertain);
  return std::log(probability / (1 - probability));
}

}  // namespace

double TrackScore::level() const { return sum_ / (kDoubt + weight_); }

float TrackScore::update(float score, double elapsed) {
  const double kept = std::exp(-elapsed / kMemory);
  sum_ *= kept;
  weight_ *= kept;
  const double now = log_odds(score);
  const double odds = kShift + kNow * now + kBefore * level();
  sum_ += now;
  weight_ += 1;
  return static_cast<float>(1 / (1 + std::exp(-odds)));
}

}  // namespace bole
