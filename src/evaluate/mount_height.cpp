#include "evaluate/mount_height.h"

#include <cmath>
#include <optional>
#include <stdexcept>

#include "evaluate/drawing.h"
#include "evaluate/figures.h"

namespace bole {
namespace {

constexpr double kMostRatio = 1.7;     // of heights, true and supposed
constexpr double kFootSigma = 0.008;   // tangent: where grass and flare let a foot end
constexpr double kGroundSigma = 0.02;  // metres, of ground that is even
constexpr double kTapeSigma = 0.01;    // share of a measured range

// The true height over the supposed one, if this is the tree.
double height_ratio(const TiltWitness& witness, const MeasuredTree& tree, double height) {
  const TrunkSight& sight = witness.sight;
  return tree.range * sight.down * (1 - std::sin(sight.angular_width / 2)) / height;
}

// The nearest in bearing of those that can be the tree.
std::optional<TiltWitness> find(const MeasuredTree& tree, const std::vector<TiltWitness>& frame,
                                double height) {
  std::optional<TiltWitness> nearest;
  double least = kSameBearing;
  for (const TiltWitness& witness : frame) {
    const double off = std::abs(wrap_angle(witness.bearing - tree.bearing));
    const double ratio = height_ratio(witness, tree, height);
    if (off >= least || ratio < 1 / kMostRatio || ratio > kMostRatio) continue;
    least = off;
    nearest = witness;
  }
  return nearest;
}

// What one tree says, in the median over frames.
struct Testimony {
  double ratio = 0;     // of heights
  double variance = 0;  // of it, by what no other tree shares
  cv::Vec2d by_tilt;    // how it grows with the mount's tilt, which they all share
};

Testimony hear(const MeasuredTree& tree, std::span<const std::vector<TiltWitness>> frames,
               double height) {
  std::vector<double> ratios, downs;
  for (const std::vector<TiltWitness>& frame : frames) {
    if (const auto witness = find(tree, frame, height)) {
      ratios.push_back(height_ratio(*witness, tree, height));
      downs.push_back(witness->sight.down);
    }
  }
  if (ratios.empty()) {
    throw std::runtime_error("no trunk is found within " + fixed(degrees(kSameBearing), 0) +
                             " degrees of bearing " + fixed(degrees(tree.bearing), 1) +
                             " at some " + fixed(tree.range, 1) +
                             " m; measure one that bolectl detect finds");
  }
  const double down = *median(downs);
  const double sigma = std::hypot(kFootSigma / down, kGroundSigma / height, kTapeSigma);
  return {*median(ratios), sigma * sigma,
          cv::Vec2d(std::cos(tree.bearing), std::sin(tree.bearing)) / down};
}

}  // namespace

// The sigma is that of the trees' mean, which their median comes close to.
Measured estimate_height(std::span<const std::vector<TiltWitness>> frames,
                         std::span<const MeasuredTree> trees, double height,
                         const cv::Matx22d& tilt_covariance) {
  std::vector<double> ratios;
  double variance = 0;
  cv::Vec2d by_tilt;
  const auto count = static_cast<double>(trees.size());
  for (const MeasuredTree& tree : trees) {
    const Testimony testimony = hear(tree, frames, height);
    ratios.push_back(testimony.ratio);
    variance += testimony.variance / (count * count);
    by_tilt += testimony.by_tilt / count;
  }
  variance += by_tilt.dot(tilt_covariance * by_tilt);
  const double ratio = *median(ratios);
  return {height * ratio, height * ratio * std::sqrt(variance)};
}

}  // namespace bole
