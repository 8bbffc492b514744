#include "detect/bole_detector.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "detect/ground_tilt.h"
#include "detect/range_posterior.h"
#include "detect/trunk_finder.h"

namespace bole {
namespace {

constexpr float kLeastScore = 0.05F;
constexpr float kWitness = 0.3F;  // probability of a trunk that tells of the ground's tilt

float probability(float logit) { return 1 / (1 + std::exp(-logit)); }

// What scripts/calibration fits on drives through cameras that nothing was trained on.
float calibrated(double score) {
  constexpr double kSlope = 1.07, kShift = 0.21;
  if (score >= 1) return 1;
  return static_cast<float>(1 / (1 + std::exp(-kSlope * std::log(score / (1 - score)) - kShift)));
}

class BoleDetector final : public Detector {
 public:
  explicit BoleDetector(const DetectorSetup& setup)
      : panorama_(setup.panorama),
        range_(setup.height, setup.search),
        tilt_(setup.height),
        finder_(setup) {
    trees_.reserve(256);
    witnesses_.reserve(256);
  }

  std::span<const Tree> detect(const PanoramaView& panorama) override {
    trees_.clear();
    const std::span<const Trunk> trunks = finder_.find(panorama);
    const GroundTilt tilt = tilt_of(trunks);
    for (const Trunk& trunk : trunks) {
      // Its place can only make it less probable.
      if (calibrated(probability(trunk.logit)) < kLeastScore) continue;
      const Tree tree = tree_of(trunk, tilt);
      if (tree.score >= kLeastScore && trees_.size() < trees_.capacity()) trees_.push_back(tree);
    }
    // Not std::stable_sort, which allocates.
    std::sort(trees_.begin(), trees_.end(), [](const Tree& a, const Tree& b) {
      return std::tie(b.score, a.bearing) < std::tie(a.score, b.bearing);
    });
    return trees_;
  }

 private:
  TrunkSight sight_of(const Trunk& trunk) const;
  GroundTilt tilt_of(std::span<const Trunk> trunks);
  Tree tree_of(const Trunk& trunk, const GroundTilt& tilt) const;

  PanoramaGeometry panorama_;
  RangePosterior range_;
  TiltEstimator tilt_;
  TrunkFinder finder_;
  std::vector<TiltWitness> witnesses_;
  std::vector<Tree> trees_;
};

TrunkSight BoleDetector::sight_of(const Trunk& trunk) const {
  const double focal = panorama_.focal();
  return {.down = -panorama_.tangent_of_row(trunk.shape.foot - 0.5),
          .down_sigma = trunk.foot_sigma / focal,
          .angular_width = std::clamp(trunk.shape.width() / focal, 1e-3, 2.5)};
}

GroundTilt BoleDetector::tilt_of(std::span<const Trunk> trunks) {
  witnesses_.clear();
  for (const Trunk& trunk : trunks) {
    if (probability(trunk.logit) < kWitness || witnesses_.size() == witnesses_.capacity()) continue;
    witnesses_.push_back({.bearing = panorama_.bearing_of_column(trunk.shape.centre() - 0.5),
                          .sight = sight_of(trunk),
                          .lean = trunk.shape.slope(),
                          .weight = probability(trunk.logit)});
  }
  return tilt_.estimate(witnesses_);
}

Tree BoleDetector::tree_of(const Trunk& trunk, const GroundTilt& tilt) const {
  const TrunkShape& shape = trunk.shape;
  const double focal = panorama_.focal();
  const double bearing = panorama_.bearing_of_column(shape.centre() - 0.5);
  const TrunkSight seen = sight_of(trunk);
  TrunkSight level = seen;
  level.down += tilt.raise(bearing);
  const RangeEstimate place = range_.estimate(level);
  Tree tree;
  if (place.searched <= 0) return tree;
  const double diameter = 2 * place.range * std::sin(seen.angular_width / 2);
  tree.bearing = static_cast<float>(bearing);
  tree.range = static_cast<float>(place.range);
  tree.diameter = static_cast<float>(diameter);
  tree.score = calibrated(probability(trunk.logit) * place.searched);
  tree.bearing_sigma = static_cast<float>(trunk.centre_sigma / focal);
  tree.range_sigma = static_cast<float>(place.sigma);
  tree.diameter_sigma =
      static_cast<float>(diameter * std::hypot(trunk.width_sigma, place.sigma / place.range));
  tree.base_elevation = static_cast<float>(std::atan(-seen.down));
  tree.angular_width = static_cast<float>(seen.angular_width);
  return tree;
}

}  // namespace

std::unique_ptr<Detector> make_bole_detector(const DetectorSetup& setup) {
  return std::make_unique<BoleDetector>(setup);
}

}  // namespace bole
