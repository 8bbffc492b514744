#pragma once

#include <array>
#include <span>

namespace bole {

/// How the robot moved between two frames, in the axes it had at the first: metres forward, metres
/// to its left, radians of turn to its left.
struct EgoMotion {
  double forward = 0;
  double left = 0;
  double turn = 0;
};

/// A place on the ground in the robot frame, metres.
struct GroundPoint {
  double x = 0;
  double y = 0;
};

/// Where a fixed point is seen from after the robot has moved.
GroundPoint moved(const GroundPoint& point, const EgoMotion& motion);

/// A tree's place before the motion, where it is seen after it, and how well each is known.
struct Sighting {
  GroundPoint before;
  double bearing = 0, range = 0;                    ///< after
  double bearing_variance = 0, range_variance = 0;  ///< of both ends together
};

/// A motion with standard deviations.
struct MotionEstimate {
  EgoMotion mean;
  double forward_sigma = 0.1;  ///< metres
  double left_sigma = 0.1;     ///< metres
  double turn_sigma = 0.1;     ///< radians
};

/// The motion that explains the sightings and the prior best: Gauss-Newton over bearings and
/// ranges, sightings weighted down by Cauchy's function of their own misfit, so that a wrong pair
/// costs little. Without sightings the prior.
MotionEstimate estimate_motion(std::span<const Sighting> sightings, const MotionEstimate& prior);

}  // namespace bole
