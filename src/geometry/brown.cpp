#include "geometry/brown.h"

#include <cmath>

#include "geometry/monotone.h"

namespace bole {
namespace {

using Coefficients = BrownDistortion::Coefficients;

constexpr double kStep = 0.005;
constexpr double kFarthest = 20;  // from the axis: 87 degrees of a perspective camera

double stretch(const Coefficients& k, double r2) {
  return 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
}

// The derivative of r stretch(r^2).
double slope(const Coefficients& k, double r) {
  const double r2 = r * r;
  return 1 + r2 * (3 * k[0] + r2 * (5 * k[1] + r2 * 7 * k[4]));
}

}  // namespace

BrownDistortion::BrownDistortion(const Coefficients& coefficients)
    : k_(coefficients),
      largest_radius_(
          grows_until([&](double r) { return slope(coefficients, r); }, kStep, kFarthest)) {}

PlanePoint BrownDistortion::formula(PlanePoint p) const {
  const double r2 = p.x * p.x + p.y * p.y, radial = stretch(k_, r2);
  return {p.x * radial + 2 * k_[2] * p.x * p.y + k_[3] * (r2 + 2 * p.x * p.x),
          p.y * radial + k_[2] * (r2 + 2 * p.y * p.y) + 2 * k_[3] * p.x * p.y};
}

std::optional<PlanePoint> BrownDistortion::distorted(PlanePoint point) const {
  if (!(std::hypot(point.x, point.y) < largest_radius_)) return std::nullopt;
  return formula(point);
}

// The radial part alone first, which cannot fail; from there Newton's steps in the plane.
std::optional<PlanePoint> BrownDistortion::undistorted(PlanePoint seen) const {
  const double seen_radius = std::hypot(seen.x, seen.y);
  if (seen_radius == 0) return seen;
  const double radius = root_between([&](double r) { return r * stretch(k_, r * r) - seen_radius; },
                                     [&](double r) { return slope(k_, r); }, 0, largest_radius_);
  PlanePoint p{seen.x * radius / seen_radius, seen.y * radius / seen_radius};
  double off = 0;
  for (int step = 0; step < 20; ++step) {
    const PlanePoint at = formula(p);
    const double ex = seen.x - at.x, ey = seen.y - at.y;
    off = std::hypot(ex, ey);
    if (!(off > 1e-15 * seen_radius)) break;
    const double r2 = p.x * p.x + p.y * p.y, radial = stretch(k_, r2);
    const double growth = 2 * (k_[0] + r2 * (2 * k_[1] + r2 * 3 * k_[4]));  // of radial, by r2 / 2
    const double xx = radial + growth * p.x * p.x + 2 * k_[2] * p.y + 6 * k_[3] * p.x;
    const double xy = growth * p.x * p.y + 2 * k_[2] * p.x + 2 * k_[3] * p.y;
    const double yy = radial + growth * p.y * p.y + 6 * k_[2] * p.y + 2 * k_[3] * p.x;
    const double determinant = xx * yy - xy * xy;
    p = {p.x + (yy * ex - xy * ey) / determinant, p.y + (xx * ey - xy * ex) / determinant};
  }
  const bool found = off <= 1e-9 * seen_radius && std::hypot(p.x, p.y) < largest_radius_;
  return found ? std::optional(p) : std::nullopt;
}

}  // namespace bole
