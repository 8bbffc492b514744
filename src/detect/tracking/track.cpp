#include "detect/tracking/track.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/angles.h"
#include "geometry/ground.h"

namespace bole {
namespace {

// Standard deviations of the range's lasting and its fleeting error, in the detector's sigmas, and
// how long the lasting one lasts.
constexpr double kLasting = 1.0, kFleeting = 1.0;
constexpr double kLastingSeconds = 3.0;
// Bearings and widths err alike in frames that follow each other: so many sightings count for one.
constexpr double kAlikeBearings = 4.0, kAlikeWidths = 3.0;
// The robot's way is known from the trees alone, and its length no better than this share.
constexpr double kScale = 0.04;
constexpr float kCredible = 0.2F;  // probability
constexpr double kNewDrop = 0.5;   // share of a new foot in the expected one
constexpr double kOutlier = 4.0;   // squared misfit, in variances, that halves a sighting's weight

double squared(double x) { return x * x; }

double foot_distance(double range, double diameter) { return std::max(range - diameter / 2, 0.1); }
double bearing_variance(const Tree& tree) { return squared(std::max(tree.bearing_sigma, 0.003F)); }
double range_sigma(const Tree& tree) { return std::max(tree.range_sigma, 0.01F * tree.range); }
// Of the diameter as the width alone tells it, were the range known.
double width_variance(const Tree& tree) {
  const double share =
      squared(tree.diameter_sigma / tree.diameter) - squared(tree.range_sigma / tree.range);
  return squared(tree.diameter) * std::max(share, squared(0.03));
}

}  // namespace

Track::Track(std::int32_t id, Tree& tree)
    : id_(id),
      state_{tree.range * std::cos(tree.bearing), tree.range * std::sin(tree.bearing), 0},
      diameter_(std::max(tree.diameter, 0.01F)),
      diameter_variance_(width_variance(tree)) {
  const double c = std::cos(tree.bearing), s = std::sin(tree.bearing);
  const double sigma = range_sigma(tree), lasting = squared(kLasting);
  const double along = squared(sigma) * (lasting + squared(kFleeting));
  const double across = bearing_variance(tree) * squared(tree.range);
  // What the range errs by, the position errs by, the other way.
  const double both = -sigma * lasting;
  covariance_ = {{Vec3{c * c * along + s * s * across, c * s * (along - across), c * both},
                  Vec3{c * s * (along - across), s * s * along + c * c * across, s * both},
                  Vec3{c * both, s * both, lasting}}};
  drop_ = drop_of(tree);
  tree.id = id_;
  judge(tree);
}

double Track::range_variance() const {
  const Vec3 along{state_.x / range(), state_.y / range(), 0};
  return dot(along, covariance_ * along) + squared(kScale * range());
}

void Track::judge(Tree& tree) {
  ++sightings_;
  const double seen = std::min(1.0, static_cast<double>(sightings_) / frames_);
  tree.score = score_.update(tree.score, seen, std::sqrt(range_variance()) / range());
  probability_ = tree.score;
}

// At the side of the trunk that is seen. Grass or a slope at the foot is in it and stays with the
// tree.
double Track::drop_of(const Tree& tree) const {
  return -std::tan(tree.base_elevation) * foot_distance(range(), diameter_);
}

void Track::scale(double factor) {
  state_.x *= factor;
  state_.y *= factor;
  diameter_ *= factor;
}

void Track::widen(const Tree& whole) {
  const double known = range();
  state_.x = known * std::cos(whole.bearing);
  state_.y = known * std::sin(whole.bearing);
  diameter_ = 2 * known * std::sin(whole.angular_width / 2);
  diameter_variance_ = width_variance(whole);
}

ExpectedTrunk Track::after(const EgoMotion& motion) const {
  const GroundPoint at = moved(position(), motion);
  const double range = std::hypot(at.x, at.y);
  return {.bearing = static_cast<float>(std::atan2(at.y, at.x)),
          .base_elevation = static_cast<float>(std::atan(-drop_ / foot_distance(range, diameter_))),
          .angular_width = static_cast<float>(angular_width(diameter_, range))};
}

Vec3 Track::bearing_gradient() const {
  const double square = squared(state_.x) + squared(state_.y);
  return {-state_.y / square, state_.x / square, 0};
}

Vec3 Track::range_gradient(const Tree& tree) const {
  return {state_.x / range(), state_.y / range(), range_sigma(tree)};
}

void Track::move(const MotionEstimate& motion, double elapsed) {
  const GroundPoint at = moved(position(), motion.mean);
  const double kept = std::exp(-elapsed / kLastingSeconds);
  const Mat3 turn = rotation_z(-motion.mean.turn);
  state_ = {at.x, at.y, kept * state_.z};
  covariance_ = turn * covariance_ * transposed(turn);
  auto& [x, y, u] = covariance_.rows;
  x.z *= kept, y.z *= kept, u = {kept * u.x, kept * u.y, kept * kept * u.z};
  const double noise = squared(0.01 + 0.003 * range()) * (elapsed / 0.1);
  x.x += noise;
  y.y += noise;
  u.z += squared(kLasting) * (1 - kept * kept);
  ++frames_;
  unseen_ += elapsed;
  doubtful_ += elapsed;
}

Track::Expectation Track::expect(const Tree& tree) const {
  const Vec3 across = bearing_gradient(), along = range_gradient(tree);
  return {std::atan2(state_.y, state_.x), range() + range_sigma(tree) * state_.z,
          dot(across, covariance_ * across) + bearing_variance(tree),
          dot(along, covariance_ * along) + squared(kFleeting * range_sigma(tree))};
}

void Track::observe(const Vec3& gradient, double residual, double variance) {
  const Vec3 shared = covariance_ * gradient;
  const double certain = dot(gradient, shared);
  const double misfit = squared(residual) / (certain + variance);
  const double total = certain + variance * (1 + misfit / kOutlier);
  const double k = residual / total;
  state_ = {state_.x + k * shared.x, state_.y + k * shared.y, state_.z + k * shared.z};
  const std::array<double, 3> column{shared.x, shared.y, shared.z};
  for (int i = 0; i < 3; ++i) {
    Vec3& row = covariance_.rows[i];
    const double g = column[i] / total;
    row = {row.x - g * shared.x, row.y - g * shared.y, row.z - g * shared.z};
  }
}

void Track::see(Tree& tree) {
  const double turn = wrap_angle(tree.bearing - std::atan2(state_.y, state_.x));
  observe(bearing_gradient(), turn, kAlikeBearings * bearing_variance(tree));
  observe(range_gradient(tree), tree.range - range() - range_sigma(tree) * state_.z,
          squared(kFleeting * range_sigma(tree)));

  const double seen = 2 * range() * std::sin(tree.angular_width / 2);
  const double misfit = squared(seen - diameter_) / (diameter_variance_ + width_variance(tree));
  const double variance = kAlikeWidths * width_variance(tree) * (1 + misfit / kOutlier);
  const double gain = diameter_variance_ / (diameter_variance_ + variance);
  diameter_ += gain * (seen - diameter_);
  diameter_variance_ = (1 - gain) * diameter_variance_ + squared(0.001);

  if (tree.score > kCredible) doubtful_ = 0;
  judge(tree);
  drop_ += kNewDrop * (drop_of(tree) - drop_);

  unseen_ = 0;
  write(tree);
}

void Track::write(Tree& tree) const {
  const Vec3 across = bearing_gradient();
  tree.id = id_;
  tree.bearing = static_cast<float>(std::atan2(state_.y, state_.x));
  tree.range = static_cast<float>(range());
  tree.diameter = static_cast<float>(diameter_);
  tree.bearing_sigma = static_cast<float>(std::sqrt(dot(across, covariance_ * across)));
  tree.range_sigma = static_cast<float>(std::sqrt(range_variance()));
  tree.diameter_sigma = static_cast<float>(
      std::sqrt(diameter_variance_ + range_variance() * squared(diameter_ / range())));
  tree.angular_width = static_cast<float>(angular_width(diameter_, range()));
}

}  // namespace bole
