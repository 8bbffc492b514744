#include "detect/ground_tilt.h"

#include <algorithm>
#include <cmath>

#include "geometry/angles.h"

namespace bole {
namespace {

constexpr double kNarrowest = 0.004, kWidest = 1.0;    // radians
constexpr double kHighest = -0.4, kDownStep = 0.01;    // tangents of depression
constexpr double kLeanStep = 0.005;                    // columns a row
constexpr double kFootSigma = 0.004;                   // tangent
constexpr double kLeanSigma = 0.035, kCrooked = 0.15;  // of straight trees; share of the others
constexpr double kCrookedSigma = 0.12;
constexpr double kTiltSigma = 0.04, kSlopeSigma = 0.10;  // tangents, where there is any
constexpr double kLevel = 1.5;                           // log odds of level ground
constexpr std::size_t kFewest = 3;                       // witnesses
constexpr double kStep = 0.04;                           // tangent, between tilts that are weighed

double normal(double x, double sigma) { return std::exp(-0.5 * (x / sigma) * (x / sigma)) / sigma; }

// Logarithm of the probability that a tilt lies within half a step of this one, where there is any.
double log_prior(const GroundTilt& tilt, double sigma) {
  const double square = tilt.forward * tilt.forward + tilt.left * tilt.left;
  return std::log(kStep * kStep / (2 * kPi * sigma * sigma)) - 0.5 * square / (sigma * sigma);
}

}  // namespace

double GroundTilt::raise(double bearing) const {
  return raise(std::cos(bearing), std::sin(bearing));
}

double GroundTilt::lean(double bearing) const { return lean(std::cos(bearing), std::sin(bearing)); }

TiltEstimator::TiltEstimator(double height) : feet_(kWidths) {
  ready_.reserve(kMostWitnesses);
  for (int row = -kReach, i = 0; row <= kReach; ++row) {
    for (int column = -kReach; column <= kReach; ++column)
      tilts_[i++] = {.forward = kStep * column, .left = kStep * row};
  }
  // Every range and size: what is searched for does not bear on where the ground is.
  const RangePosterior posterior(height, Search{{0.1, 1000}, {0.001, 100}});
  for (int w = 0; w < kWidths; ++w) {
    const double width = kNarrowest * std::pow(kWidest / kNarrowest, (w + 0.5) / kWidths);
    for (int i = 0; i < kDowns; ++i) {
      feet_[w][i] = static_cast<float>(
          posterior.log_likelihood({kHighest + i * kDownStep, kFootSigma, width}));
    }
  }
  for (int i = 0; i < kLeans; ++i) {
    leans_[i] = static_cast<float>(std::log((1 - kCrooked) * normal(i * kLeanStep, kLeanSigma) +
                                            kCrooked * normal(i * kLeanStep, kCrookedSigma)));
  }
}

TiltEstimator::Ready TiltEstimator::made_ready(const TiltWitness& witness) const {
  const double width =
      std::log(witness.sight.angular_width / kNarrowest) / std::log(kWidest / kNarrowest) * kWidths;
  return {.feet = feet_[static_cast<std::size_t>(std::clamp(width, 0.0, kWidths - 1.0))].data(),
          .down = witness.sight.down,
          .cos_bearing = std::cos(witness.bearing),
          .sin_bearing = std::sin(witness.bearing),
          .lean = witness.lean,
          .weight = witness.weight};
}

// How likely feet there are under trunks of those widths, if the ground is raised so.
double TiltEstimator::feet(const GroundTilt& ground) const {
  double sum = 0;
  for (const Ready& w : ready_) {
    const double down = w.down + ground.raise(w.cos_bearing, w.sin_bearing);
    const double place = std::clamp((down - kHighest) / kDownStep, 0.0, kDowns - 1.001);
    const float* at = w.feet + static_cast<int>(place);
    sum += w.weight * (at[0] + (place - static_cast<int>(place)) * (at[1] - at[0]));
  }
  return sum;
}

// How likely those leans are, if the camera is tilted so.
double TiltEstimator::lean(const GroundTilt& camera) const {
  double sum = 0;
  for (const Ready& w : ready_) {
    const double off = std::abs(w.lean - camera.lean(w.cos_bearing, w.sin_bearing)) / kLeanStep;
    sum += w.weight * leans_[static_cast<std::size_t>(std::min(off, kLeans - 1.0))];
  }
  return sum;
}

// Between the tilts that are weighed anything may be: a step's own variance adds to theirs.
TiltEstimator::Hypothesis TiltEstimator::weigh(const ByTilt& values) const {
  const auto highest = std::max_element(values.begin(), values.end());
  double sum = 0, forward = 0, left = 0, squares = 0;
  for (int i = 0; i < kTilts; ++i) {
    const GroundTilt& tilt = tilts_[i];
    const double weight = std::exp(values[i] - *highest);
    sum += weight;
    forward += weight * tilt.forward;
    left += weight * tilt.left;
    squares += weight * (tilt.forward * tilt.forward + tilt.left * tilt.left);
  }
  const double variance = (squares - (forward * forward + left * left) / sum) / sum / 2;
  return {.log_probability = *highest + std::log(sum),
          .likeliest = tilts_[highest - values.begin()],
          .sigma = std::sqrt(variance + kStep * kStep / 12)};
}

// The tilt of the highest value that can be reached from `start` by steps that get smaller.
template <class Value>
GroundTilt TiltEstimator::climb(const Value& value, const GroundTilt& start) {
  GroundTilt best = start;
  double highest = value(start);
  for (double step = kStep / 2; step > 0.002;) {
    const GroundTilt from = best;
    for (const auto& [x, y] :
         {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}) {
      const GroundTilt next{.forward = from.forward + x * step, .left = from.left + y * step};
      const double here = value(next);
      if (here <= highest) continue;
      best = next;
      highest = here;
    }
    if (best.forward == from.forward && best.left == from.left) step /= 2;
  }
  return best;
}

GroundTilt TiltEstimator::estimate(std::span<const TiltWitness> witnesses) {
  if (witnesses.size() < kFewest) return {};
  ready_.clear();
  for (const TiltWitness& witness : witnesses) ready_.push_back(made_ready(witness));
  const double upright = lean({});  // as trunks are on a slope, too
  const auto as_tilted = [&](const GroundTilt& t, double stands) {
    return stands + lean(t) + log_prior(t, kTiltSigma);
  };
  const auto as_slope = [&](const GroundTilt& t, double stands) {
    return stands + upright + log_prior(t, kSlopeSigma);
  };
  ByTilt tilted, sloping;
  for (int i = 0; i < kTilts; ++i) {
    const double stands = feet(tilts_[i]);
    tilted[i] = as_tilted(tilts_[i], stands);
    sloping[i] = as_slope(tilts_[i], stands);
  }
  const Hypothesis tilt = weigh(tilted), slope = weigh(sloping);
  const bool is_slope = slope.log_probability > tilt.log_probability;
  const Hypothesis& other = is_slope ? slope : tilt;
  if (other.log_probability <= feet({}) + upright + kLevel) return {};
  const auto value = [&](const GroundTilt& t) {
    return is_slope ? as_slope(t, feet(t)) : as_tilted(t, feet(t));
  };
  GroundTilt found = climb(value, other.likeliest);
  found.sigma = other.sigma;
  return found;
}

}  // namespace bole
