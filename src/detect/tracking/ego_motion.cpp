#include "detect/tracking/ego_motion.h"

#include <algorithm>
#include <cmath>

#include "geometry/angles.h"
#include "geometry/rotation.h"

namespace bole {
namespace {

// The normal equations of a least-squares problem in (forward, left, turn).
struct NormalEquations {
  Mat3 matrix{{Vec3{}, Vec3{}, Vec3{}}};
  Vec3 right;

  void add(const Vec3& gradient, double residual, double weight) {
    const std::array<double, 3> g{gradient.x, gradient.y, gradient.z};
    for (int i = 0; i < 3; ++i) {
      Vec3& row = matrix.rows[i];
      row = {row.x + weight * g[i] * g[0], row.y + weight * g[i] * g[1],
             row.z + weight * g[i] * g[2]};
    }
    right = {right.x + weight * residual * g[0], right.y + weight * residual * g[1],
             right.z + weight * residual * g[2]};
  }

  // By Cramer's rule; the prior keeps the matrix well away from singular. Symmetric: rows are
  // columns.
  Vec3 solution() const {
    const auto& [a, b, c] = matrix.rows;
    return {dot(right, cross(b, c)) / determinant(), dot(a, cross(right, c)) / determinant(),
            dot(a, cross(b, right)) / determinant()};
  }
  // The diagonal of the inverse: the variances of forward, left and turn.
  Vec3 variances() const {
    const auto& [a, b, c] = matrix.rows;
    return {cross(b, c).x / determinant(), cross(c, a).y / determinant(),
            cross(a, b).z / determinant()};
  }

 private:
  static Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  double determinant() const { return dot(matrix.rows[0], cross(matrix.rows[1], matrix.rows[2])); }
};

void add_sighting(NormalEquations& equations, const Sighting& sighting, const EgoMotion& motion) {
  constexpr double kCauchy = 4.0;  // squared misfit, in variances, at which the weight is a half
  const GroundPoint at = moved(sighting.before, motion);
  const double range = std::max(std::hypot(at.x, at.y), 0.05);
  const double cx = at.x / range, cy = at.y / range;
  // at = R(-turn)(before - shift): its derivatives by forward, left and turn.
  const double c = std::cos(motion.turn), s = std::sin(motion.turn);
  const Vec3 dx{-c, -s, at.y}, dy{s, -c, -at.x};
  const Vec3 range_gradient{cx * dx.x + cy * dy.x, cx * dx.y + cy * dy.y, cx * dx.z + cy * dy.z};
  const Vec3 bearing_gradient{(cx * dy.x - cy * dx.x) / range, (cx * dy.y - cy * dx.y) / range,
                              (cx * dy.z - cy * dx.z) / range};
  const double bearing_error = wrap_angle(sighting.bearing - std::atan2(at.y, at.x));
  const double range_error = sighting.range - range;
  const double misfit = bearing_error * bearing_error / sighting.bearing_variance +
                        range_error * range_error / sighting.range_variance;
  const double weight = 1 / (1 + misfit / kCauchy);
  equations.add(bearing_gradient, bearing_error, weight / sighting.bearing_variance);
  equations.add(range_gradient, range_error, weight / sighting.range_variance);
}

void add_prior(NormalEquations& equations, const MotionEstimate& prior, const EgoMotion& motion) {
  const double forward = 1 / (prior.forward_sigma * prior.forward_sigma);
  const double left = 1 / (prior.left_sigma * prior.left_sigma);
  const double turn = 1 / (prior.turn_sigma * prior.turn_sigma);
  equations.add({1, 0, 0}, prior.mean.forward - motion.forward, forward);
  equations.add({0, 1, 0}, prior.mean.left - motion.left, left);
  equations.add({0, 0, 1}, prior.mean.turn - motion.turn, turn);
}

}  // namespace

GroundPoint moved(const GroundPoint& point, const EgoMotion& motion) {
  const double x = point.x - motion.forward, y = point.y - motion.left;
  const double c = std::cos(motion.turn), s = std::sin(motion.turn);
  return {c * x + s * y, -s * x + c * y};
}

MotionEstimate estimate_motion(std::span<const Sighting> sightings, const MotionEstimate& prior) {
  MotionEstimate estimate = prior;
  EgoMotion& motion = estimate.mean;
  for (int step = 0; step < 8; ++step) {
    NormalEquations equations;
    add_prior(equations, prior, motion);
    for (const Sighting& sighting : sightings) add_sighting(equations, sighting, motion);
    const Vec3 change = equations.solution();
    const Vec3 variances = equations.variances();
    motion = {motion.forward + change.x, motion.left + change.y, motion.turn + change.z};
    estimate.forward_sigma = std::sqrt(variances.x);
    estimate.left_sigma = std::sqrt(variances.y);
    estimate.turn_sigma = std::sqrt(variances.z);
    if (norm(change) < 1e-6) break;
  }
  return estimate;
}

}  // namespace bole
