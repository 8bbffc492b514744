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
  return forward * std::cos(bearing) + left * std::sin(bearing);
}

double GroundTilt::lean(double bearing) const {
  return forward * std::sin(bearing) - left * std::cos(bearing);
}

TiltEstimator::TiltEstimator(double height) : feet_(kWidths) {
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

double TiltEstimator::feet(const TiltWitness& witness, const GroundTilt& tilt) const {
  const double w =
      std::log(witness.sight.angular_width / kNarrowest) / std::log(kWidest / kNarrowest) * kWidths;
  const auto& row = feet_[static_cast<std::size_t>(std::clamp(w, 0.0, kWidths - 1.0))];
  const double place =
      std::clamp((witness.sight.down + tilt.raise(witness.bearing) - kHighest) / kDownStep, 0.0,
                 kDowns - 1.001);
  const auto i = static_cast<std::size_t>(place);
  return row[i] + (place - static_cast<double>(i)) * (row[i + 1] - row[i]);
}

double TiltEstimator::lean(double off) const {
  return leans_[static_cast<std::size_t>(std::min(std::abs(off) / kLeanStep, kLeans - 1.0))];
}

// The tilt of the highest value that can be reached from none by steps that get smaller.
template <class Value>
GroundTilt TiltEstimator::climb(const Value& value) {
  GroundTilt best;
  double most = value(best);
  for (double step = 0.04; step > 0.002;) {
    const GroundTilt from = best;
    for (const auto& [x, y] :
         {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}) {
      const GroundTilt next{from.forward + x * step, from.left + y * step};
      const double here = value(next);
      if (here <= most) continue;
      most = here;
      best = next;
    }
    if (best.forward == from.forward && best.left == from.left) step /= 2;
  }
  return best;
}

GroundTilt TiltEstimator::estimate(std::span<const TiltWitness> witnesses) const {
  if (witnesses.size() < kFewest) return {};
  const auto likelihood = [&](const GroundTilt& ground, const GroundTilt& camera) {
    double sum = 0;
    for (const TiltWitness& w : witnesses)
      sum += w.weight * (feet(w, ground) + lean(w.lean - camera.lean(w.bearing)));
    return sum;
  };
  const auto tilted = [&](const GroundTilt& t) {
    return likelihood(t, t) - against(t, kTiltSigma);
  };
  const auto sloping = [&](const GroundTilt& t) {
    return likelihood(t, {}) - against(t, kSlopeSigma);
  };
  const GroundTilt tilt = climb(tilted), slope = climb(sloping);
  const double none = likelihood({}, {});
  if (none >= std::max(tilted(tilt), sloping(slope))) return {};
  return tilted(tilt) > sloping(slope) ? tilt : slope;
}

}  // namespace bole
