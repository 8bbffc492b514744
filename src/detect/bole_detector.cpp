#include "detect/bole_detector.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "detect/ground_tilt.h"
#include "detect/log_odds.h"
#include "detect/range_posterior.h"
#include "detect/tilt_witness.h"
#include "detect/trunk_finder.h"

namespace bole {
namespace {

constexpr float kLeastScore = 0.05F;
constexpr float kHardly = 0.02F;  // probability that is not worth a place
constexpr std::size_t kMostExpected = 64;
constexpr std::size_t kMostTrees = 256;

// What scripts/calibration fits on drives through cameras that nothing was trained on. Where many
// trees are seen, what looks a little like one is one more often than elsewhere; `seen` is how many
// there probably are.
float calibrated(double score, double seen) {
  constexpr double kSlope = 0.94, kShift = 0.00, kCrowd = 0.56, kFew = 7;
  if (score >= 1) return 1;
  const double crowd = kCrowd * std::log(std::max(1.0, (seen + 1) / (kFew + 1)));
  return probability(kSlope * std::log(score / (1 - score)) + kShift + crowd);
}

class BoleDetector final : public Detector {
 public:
  explicit BoleDetector(const DetectorSetup& setup)
      : panorama_(setup.panorama),
        height_(setup.height),
        range_(setup.height, setup.search),
        tilt_(setup.height),
        finder_(setup) {
    outlines_.reserve(2 * kMostExpected);
    trees_.reserve(kMostTrees);
    witnesses_.reserve(TiltEstimator::kMostWitnesses);
  }

 private:
  std::span<const Tree> find(const PanoramaView& panorama,
                             std::span<const ExpectedTrunk> expected) override {
    trees_.clear();
    outline(expected);
    const std::span<const Trunk> trunks = finder_.find(panorama, outlines_);
    const GroundTilt tilt = tilt_of(trunks);
    double seen = 0;
    for (const Trunk& trunk : trunks) {
      // Its place can only make it less probable.
      if (probability(trunk.logit) < kHardly || trees_.size() == kMostTrees) continue;
      trees_.push_back(tree_of(trunk, tilt));
      seen += trees_.back().score;
    }
    for (Tree& tree : trees_) tree.score = calibrated(tree.score, seen);
    std::erase_if(trees_, [](const Tree& tree) { return tree.score < kLeastScore; });
    // Not std::stable_sort, which allocates.
    std::sort(trees_.begin(), trees_.end(), [](const Tree& a, const Tree& b) {
      return std::tie(b.score, a.bearing) < std::tie(a.score, b.bearing);
    });
    return trees_;
  }

  void outline(std::span<const ExpectedTrunk> expected);
  GroundTilt tilt_of(std::span<const Trunk> trunks);
  Tree tree_of(const Trunk& trunk, const GroundTilt& tilt) const;

  PanoramaGeometry panorama_;
  double height_;
  RangePosterior range_;
  TiltEstimator tilt_;
  TrunkFinder finder_;
  std::vector<Candidate> outlines_;  // of the trunks that are expected
  std::vector<TiltWitness> witnesses_;
  std::vector<Tree> trees_;
};

// As dark trunks and as bright ones: which they are may change with the light.
void BoleDetector::outline(std::span<const ExpectedTrunk> expected) {
  outlines_.clear();
  for (const ExpectedTrunk& trunk : expected.first(std::min(expected.size(), kMostExpected))) {
    const double width = trunk.angular_width * panorama_.focal();
    const double middle = panorama_.column_of_bearing(trunk.bearing) + 0.5;
    const double foot = panorama_.row_of_tangent(std::tan(trunk.base_elevation)) + 0.5;
    for (const bool dark : {true, false}) {
      outlines_.push_back({.left = static_cast<float>(middle - width / 2),
                           .width = static_cast<float>(width),
                           .foot = static_cast<float>(std::clamp(foot, 0.0, 1.0 * panorama_.rows)),
                           .dark = dark});
    }
  }
}

GroundTilt BoleDetector::tilt_of(std::span<const Trunk> trunks) {
  witnesses_.clear();
  for (const Trunk& trunk : trunks) {
    if (witnesses_.size() == TiltEstimator::kMostWitnesses) break;
    if (const auto witness = witness_of(trunk, panorama_)) witnesses_.push_back(*witness);
  }
  return tilt_.estimate(witnesses_);
}

Tree BoleDetector::tree_of(const Trunk& trunk, const GroundTilt& tilt) const {
  const TrunkShape& shape = trunk.shape;
  const double focal = panorama_.focal();
  const double bearing = panorama_.bearing_of_column(shape.centre() - 0.5);
  const TrunkSight seen = sight_of(trunk, panorama_);
  const double raised = tilt.raise(bearing);
  TrunkSight level = seen;
  level.down += raised;
  level.down_sigma = std::hypot(seen.down_sigma, tilt.sigma);
  const RangeEstimate place = range_.estimate(level);
  Tree tree;
  if (place.searched <= 0) return tree;
  const double s = std::sin(seen.angular_width / 2), diameter = 2 * place.range * s;
  // Of a foot out of sight, where it must be.
  const double down = seen.cut ? height_ / (place.range * (1 - s)) - raised : seen.down;
  tree.bearing = static_cast<float>(bearing);
  tree.range = static_cast<float>(place.range);
  tree.diameter = static_cast<float>(diameter);
  tree.score = static_cast<float>(probability(trunk.logit) * place.searched);
  tree.bearing_sigma = static_cast<float>(trunk.centre_sigma / focal);
  tree.range_sigma = static_cast<float>(place.sigma);
  tree.diameter_sigma =
      static_cast<float>(diameter * std::hypot(trunk.width_sigma, place.sigma / place.range));
  tree.base_elevation = static_cast<float>(std::atan(-down));
  tree.angular_width = static_cast<float>(seen.angular_width);
  return tree;
}

}  // namespace

std::unique_ptr<Detector> make_bole_detector(const DetectorSetup& setup) {
  return std::make_unique<BoleDetector>(setup);
}

}  // namespace bole
