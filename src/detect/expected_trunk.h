#pragma once

namespace bole {

/// Where earlier frames lead to expect a trunk, and how it should look: robot frame, radians, named
/// as in Tree. Nothing of it is published: it is where to look.
struct ExpectedTrunk {
  float bearing = 0;
  float base_elevation = 0;
  float angular_width = 0;
};

}  // namespace bole
