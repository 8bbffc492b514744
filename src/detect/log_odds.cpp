#include "detect/log_odds.h"

#include <algorithm>
#include <cmath>

namespace bole {

double log_odds(double probability, double certain) {
  probability = std::clamp(probability, certain, 1 - certain);
  return std::log(probability / (1 - probability));
}

float probability(double log_odds) { return static_cast<float>(1 / (1 + std::exp(-log_odds))); }

}  // namespace bole
