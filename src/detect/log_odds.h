#pragma once

namespace bole {

/// log(p / (1 - p)) of a probability p, which is taken for no nearer to 0 or 1 than `certain`.
double log_odds(double probability, double certain = 1e-4);

/// The probability of these log odds (a network's logit).
float probability(double log_odds);

}  // namespace bole
