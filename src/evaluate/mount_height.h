#pragma once

#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "detect/tilt_witness.h"
#include "geometry/angles.h"

namespace bole {

/// A number and its standard deviation.
struct Measured {
  double value = 0, sigma = 0;
};

/// A tree whose place was measured by tape from under the camera.
struct MeasuredTree {
  double bearing = 0;  ///< radians, robot frame
  double range = 0;    ///< metres, to the trunk's axis
};

/// How far in bearing what is found may stand from the measured tree, radians. Two measured trees
/// must stand farther apart, lest one trunk counts as two.
inline constexpr double kSameBearing = radians(3);

/// The true height by measured trees, from each frame's witnesses, under a mount that takes the
/// viewpoint to be `height` metres up and whose tilt is known to `tilt_covariance` (as TiltFigure):
///
///   height' = height true range / range,    range = height / (down (1 - sin(width / 2)))
///
/// as the median over frames, then over trees. A tree's witness is the nearest in bearing, within
/// kSameBearing, of those that would make the height neither 1.7 times more nor less. Throws
/// std::runtime_error when a tree has none.
Measured estimate_height(std::span<const std::vector<TiltWitness>> frames,
                         std::span<const MeasuredTree> trees, double height,
                         const cv::Matx22d& tilt_covariance);

}  // namespace bole
