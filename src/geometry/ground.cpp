#include "geometry/ground.h"

#include <cmath>
#include <limits>

#include "geometry/angles.h"

namespace bole {

double ground_distance(double tangent, double height) {
  return tangent < 0 ? -height / tangent : std::numeric_limits<double>::infinity();
}

double ground_tangent(double distance, double height) { return -height / distance; }

double diameter_from_foot(double foot_distance, double angular_width) {
  const double s = std::sin(angular_width / 2);
  return 2 * foot_distance * s / (1 - s);
}

double angular_width(double diameter, double range) {
  return diameter >= 2 * range ? kPi : 2 * std::asin(diameter / (2 * range));
}

}  // namespace bole
