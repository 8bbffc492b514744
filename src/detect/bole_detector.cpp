#include "detect/bole_detector.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "detect/trunk_finder.h"
#include "geometry/angles.h"
#include "geometry/ground.h"

namespace bole {
namespace {

constexpr double kTypicalSpread = 0.4;  // standard deviation of the logarithm of diameters
constexpr double kGroundSigma =
    0.004;  // tangent: what the ground's evenness and the attitude are good for
constexpr double kLeastScore = 0.05;

class BoleDetector final : public Detector {
 public:
  explicit BoleDetector(const DetectorSetup& setup)
      : panorama_(setup.panorama), height_(setup.height), search_(setup.search), finder_(setup) {
    trees_.reserve(256);
  }

  std::span<const Tree> detect(const PanoramaView& panorama) override {
    trees_.clear();
    for (const Trunk& trunk : finder_.find(panorama)) {
      const Tree tree = tree_of(trunk);
      if (tree.score >= kLeastScore && trees_.size() < trees_.capacity()) trees_.push_back(tree);
    }
    // Not std::stable_sort, which allocates.
    std::sort(trees_.begin(), trees_.end(), [](const Tree& a, const Tree& b) {
      return std::tie(b.score, a.bearing) < std::tie(a.score, b.bearing);
    });
    return trees_;
  }

 private:
  Tree tree_of(const Trunk& trunk) const;

  PanoramaGeometry panorama_;
  double height_;
  Search search_;
  TrunkFinder finder_;
  std::vector<Tree> trees_;
};

// Range from the foot: ground_distance(foot) to the trunk's near side. Range from the width: that
// of a trunk of typical diameter. On level ground the foot knows far better; where it contradicts
// the width by more than the searched diameters allow, the ground rises or falls and the width
// takes over.
Tree BoleDetector::tree_of(const Trunk& trunk) const {
  const TrunkShape& shape = trunk.shape;
  const double focal = panorama_.focal();
  const double width = std::clamp(shape.width() / focal, 1e-3, 2.5);
  const double s = std::sin(width / 2);
  const double down = -panorama_.tangent_of_row(shape.foot - 0.5);

  const double typical = 0.9 * std::sqrt(search_.diameter.low * search_.diameter.high);
  const double range_by_width = typical / (2 * s);
  const double down_sigma = std::hypot(trunk.foot_sigma / focal, kGroundSigma);

  double range = range_by_width, range_sigma = kTypicalSpread * range_by_width;
  const bool rising = down <= 0.3 / focal;
  if (!rising) {
    const double range_by_foot = height_ / (down * (1 - s));
    const double implied = 2 * range_by_foot * s;
    const double beyond = std::max(
        {0.0, std::log(implied / search_.diameter.high), std::log(search_.diameter.low / implied)});
    const double doubt = std::clamp((beyond - 0.15) / 0.4, 0.0, 1.0);
    const double foot_sigma = range_by_foot * std::min(1.0, down_sigma / down);
    range = std::exp((1 - doubt) * std::log(range_by_foot) + doubt * std::log(range_by_width));
    range_sigma = (1 - doubt) * foot_sigma + doubt * kTypicalSpread * range;
  }
  Tree tree;
  const bool in_range = range >= 0.9 * search_.range.low && range <= 1.1 * search_.range.high;
  if (rising)
    range = std::clamp(range, search_.range.low, search_.range.high);
  else if (!in_range)
    return tree;
  const double diameter = 2 * range * s;
  if (diameter < 0.7 * search_.diameter.low || diameter > 1.35 * search_.diameter.high) return tree;

  tree.bearing = static_cast<float>(panorama_.bearing_of_column(shape.centre() - 0.5));
  tree.range = static_cast<float>(range);
  tree.diameter = static_cast<float>(diameter);
  tree.score = trunk.probability;
  tree.bearing_sigma = static_cast<float>(trunk.centre_sigma / focal);
  tree.range_sigma = static_cast<float>(range_sigma);
  tree.diameter_sigma =
      static_cast<float>(diameter * std::hypot(trunk.width_sigma, range_sigma / range));
  tree.base_elevation = static_cast<float>(std::atan(-down));
  tree.angular_width = static_cast<float>(width);
  return tree;
}

}  // namespace

std::unique_ptr<Detector> make_bole_detector(const DetectorSetup& setup) {
  return std::make_unique<BoleDetector>(setup);
}

}  // namespace bole
