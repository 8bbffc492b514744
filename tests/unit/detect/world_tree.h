#pragma once

#include <cmath>

#include "detect/tree.h"
#include "geometry/ground.h"

namespace bole {

/// Where a tree stands in the world, and a robot; metres and radians.
struct WorldTree {
  double x, y, diameter;
};

struct Pose {
  double x = 0, y = 0, heading = 0;
};

/// As the detector lists it from `pose`, without noise.
inline Tree seen(const WorldTree& tree, const Pose& pose) {
  const GroundPoint at = moved({tree.x, tree.y}, {pose.x, pose.y, pose.heading});
  Tree result;
  result.bearing = static_cast<float>(std::atan2(at.y, at.x));
  result.range = static_cast<float>(std::hypot(at.x, at.y));
  result.diameter = static_cast<float>(tree.diameter);
  result.score = 0.9F;
  result.bearing_sigma = 0.004F;
  result.range_sigma = 0.02F * result.range;
  result.diameter_sigma = 0.03F;
  result.angular_width = static_cast<float>(angular_width(tree.diameter, result.range));
  return result;
}

}  // namespace bole
