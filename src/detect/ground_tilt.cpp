#include "detect/ground_tilt.h"

#include <algorithm>
#include <cmath>

namespace bole {
namespace {

constexpr double kNarrowest = 0.004, kWidest = 1.0;    // radians
constexpr double kHighest = -0.4, kDownStep = 0.01;    // tangents of depression
constexpr double kLeanStep = 0.005;                    // columns a row
constexpr double kFootSigma = 0.004;                   // tangent
constexpr double kLeanSigma = 0.035, kCrooked = 0.15;  // of straight trees; share of the others
constexpr double kCrookedSigma = 0.12;
constexpr double kTiltSigma = 0.04, kSlopeSigma = 0.10;  // tangents, where there is any
constexpr double kRare = 5;                              // log odds against a tilt
constexpr std::size_t kFewest = 3;                       // witnesses

double normal(double x, double sigma) { return std::exp(-0.5 * (x / sigma) * (x / sigma)) / sigma; }

double against(const GroundTilt& tilt, double sigma) {
  const double square = tilt.forward * tilt.forward + tilt.left * tilt.left;
  return kRare + 0.5 * square / (sigma * sigma);
}

}  // namespace

double GroundTilt::raise(double bearing) const {
  return raise(std::cos(bearing), std::sin(bearing));
}

double GroundTilt::lean(double bearing) const { return lean(std::cos(bearing), std::sin(bearing)); }

TiltEstimator::TiltEstimator(double height) : feet_(kWidths) {
  ready_.reserve(256);
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
  const double w =
      std::log(witness.sight.angular_width / kNarrowest) / std::log(kWidest / kNarrowest) * kWidths;
  return {.feet = feet_[static_cast<std::size_t>(std::clamp(w, 0.0, kWidths - 1.0))].data(),
          .place = (witness.sight.down - kHighest) / kDownStep,
          .cos_bearing = std::cos(witness.bearing),
          .sin_bearing = std::sin(witness.bearing),
          .lean = witness.lean,
          .weight = witness.weight};
}

double TiltEstimator::feet(const Ready& witness, const GroundTilt& tilt) {
  const double raised = tilt.raise(witness.cos_bearing, witness.sin_bearing) / kDownStep;
  const double place = std::clamp(witness.place + raised, 0.0, kDowns - 1.001);
  const auto i = static_cast<int>(place);
  const float* at = witness.feet + i;
  return at[0] + (place - i) * (at[1] - at[0]);
}

double TiltEstimator::lean(double off) const {
  return leans_[static_cast<std::size_t>(std::min(std::abs(off) / kLeanStep, kLeans - 1.0))];
}

// The tilt of the highest value that can be reached from none by steps that get smaller.
template <class Value>
TiltEstimator::Found TiltEstimator::climb(const Value& value, double start) {
  Found best{{}, start};
  for (double step = 0.04; step > 0.002;) {
    const GroundTilt from = best.tilt;
    for (const auto& [x, y] :
         {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}) {
      const GroundTilt next{from.forward + x * step, from.left + y * step};
      const double here = value(next);
      if (here > best.value) best = {next, here};
    }
    if (best.tilt.forward == from.forward && best.tilt.left == from.left) step /= 2;
  }
  return best;
}

GroundTilt TiltEstimator::estimate(std::span<const TiltWitness> witnesses) {
  if (witnesses.size() < kFewest) return {};
  ready_.clear();
  for (const TiltWitness& witness : witnesses) ready_.push_back(made_ready(witness));
  const auto likelihood = [&](const GroundTilt& ground, const GroundTilt& camera) {
    double sum = 0;
    for (const Ready& w : ready_) {
      sum +=
          w.weight * (feet(w, ground) + lean(w.lean - camera.lean(w.cos_bearing, w.sin_bearing)));
    }
    return sum;
  };
  const auto tilted = [&](const GroundTilt& t) {
    return likelihood(t, t) - against(t, kTiltSigma);
  };
  const auto sloping = [&](const GroundTilt& t) {
    return likelihood(t, {}) - against(t, kSlopeSigma);
  };
  const double none = likelihood({}, {});
  const Found tilt = climb(tilted, none - kRare), slope = climb(sloping, none - kRare);
  if (none >= std::max(tilt.value, slope.value)) return {};
  return tilt.value > slope.value ? tilt.tilt : slope.tilt;
}

}  // namespace bole
