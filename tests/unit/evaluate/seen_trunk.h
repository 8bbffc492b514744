#pragma once

#include <cmath>
#include <vector>

#include "detect/ground_tilt.h"
#include "geometry/angles.h"
#include "geometry/ground.h"
#include "geometry/rotation.h"

namespace bole {

inline constexpr double kHeight = 1.2;
inline constexpr double kShown = 0.8;  // of a lean, by the fit

using Frame = std::vector<TiltWitness>;

// A trunk on level ground as a camera sees it whose mount differs from what is said of it: `seen`
// leads from the robot frame to the one that is taken for it.
inline TiltWitness seen_through(const Mat3& seen, double bearing, double range, double diameter) {
  const double foot = range - diameter / 2;
  const auto place = [&](double up) {
    return seen * Vec3{foot * std::cos(bearing), foot * std::sin(bearing), up};
  };
  const Vec3 low = place(-kHeight), high = place(0);
  const auto turn = [](const Vec3& v) { return std::atan2(v.y, v.x); };
  const auto tangent = [](const Vec3& v) { return v.z / std::hypot(v.x, v.y); };
  const double right = wrap_angle(turn(high) - turn(low)), down = tangent(high) - tangent(low);
  return {.bearing = turn(low),
          .sight = {.down = -tangent(low),
                    .down_sigma = 0.003,
                    .angular_width = angular_width(diameter, range)},
          .lean = kShown * right / down,
          .weight = 0.9};
}

}  // namespace bole
