#pragma once

#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "detect/tilt_witness.h"

namespace bole {

/// How the ground seems to rise towards bearings 0 and pi/2 (tangents, as GroundTilt), and how well
/// that is known.
struct TiltFigure {
  cv::Vec2d tilt;
  cv::Matx22d covariance;
};

/// How a camera's mount is tilted against what camera.toml says, as the trunks of many frames tell.
struct MountTilt {
  int trunks = 0;      ///< different ones, as far as can be told
  TiltFigure by_lean;  ///< trunks stand upright
  TiltFigure by_feet;  ///< their feet stand on level ground
  TiltFigure both;
};

/// `frames`: the witnesses of each, in the order in which they were taken; `height`: of the
/// viewpoint, metres. Two robust least squares over all witnesses, t = (forward, left), b =
/// bearing:
///
///   lean = 0.8 (sin b, -cos b) t        but for each trunk's own lean; 0.8 of it is what shows
///   log x = log(down + (cos b, sin b) t + k) - log c    but for each trunk's own diameter
///
/// with x = s / (1 - s), s = sin(width / 2); c = 2 height / the typical diameter, and k for trees
/// that are thicker the farther away they are found, are fitted too.
/// A trunk that stays in sight from frame to frame counts once in all. The two are joined by how
/// well each is known: neither by more than 100 trunks, as neighbours lean and stand alike; the
/// feet no better than the ground is level. Whatever the witnesses do not tell has a standard
/// deviation of 0.1.
MountTilt estimate_mount_tilt(std::span<const std::vector<TiltWitness>> frames, double height);

}  // namespace bole
