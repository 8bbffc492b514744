#pragma once

#include <cstdint>

namespace bole {

/// A trunk as it is published: robot frame (x forward, y left, z up, origin on the ground under the
/// camera), SI units, radians. Sigmas are standard deviations.
struct Tree {
  std::int32_t id = -1;  ///< stable over frames; -1: not tracked
  float bearing = 0;     ///< atan2(y, x) of the trunk's axis at the ground
  float range = 0;       ///< horizontal distance from the camera's vertical axis to that point
  float diameter = 0;    ///< about 0.5 m up, above the root flare
  float score = 0;       ///< probability that a tree of the searched size and range stands there
  float bearing_sigma = 0;
  float range_sigma = 0;
  float diameter_sigma = 0;
  float base_elevation = 0;  ///< of the visible foot, or of a hidden foot's predicted contact
  float angular_width = 0;   ///< between the two tangent lines: sin(w / 2) = diameter / (2 range)
};

}  // namespace bole
