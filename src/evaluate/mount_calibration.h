#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "evaluate/mount_tilt.h"
#include "warp/camera_files.h"

namespace bole {

/// A tree whose place was measured by tape from under the camera.
struct MeasuredTree {
  double bearing = 0;  ///< radians, robot frame
  double range = 0;    ///< metres, to the trunk's axis
};

/// A number and its standard deviation.
struct Measured {
  double value = 0, sigma = 0;
};

/// What the trunks in many frames say of a camera's mount.
struct MountCalibration {
  Measured roll, pitch;  ///< radians
  Measured horizon_row;  ///< of a camera that has one
  Measured height;       ///< metres; sigma 0: no tree was measured, it is the old one
  /// What tilt the trunks' lean still tells of that mount, less what their feet tell.
  TiltFigure lean_against_feet;
  int frames = 0, trunks = 0;
  std::vector<std::string> unreadable;  ///< the images of no use, and why
};

/// The mount of `camera`, which is left with it, from images of trunks, in the order in which they
/// were taken: trunks stand upright, and their feet on level ground. What is found is put into the
/// warp table and looked for again until nothing is left of it. Where trees are measured, the robot
/// stood still for all images, and the height follows from
///
///   height' = height true range / range,    range = height / (down (1 - sin(width / 2)))
///
/// as the median over frames, then over trees. `progress` is told frames done and all, in each
/// round anew. Throws std::runtime_error, with the remedy, when no image is of use, the trunks are
/// too few or on one side only, or a measured tree is not found.
MountCalibration calibrate_mount(Camera& camera, std::span<const std::filesystem::path> images,
                                 std::span<const MeasuredTree> trees,
                                 const std::function<void(int, int)>& progress);

/// The true height by measured trees, from each frame's witnesses under a mount whose tilt is known
/// to `tilt_sigma` (a tangent). A tree's witness is the nearest in bearing, within 3 degrees, of
/// those that would make the height neither 1.7 times more nor less. Throws std::runtime_error when
/// a tree has none.
Measured estimate_height(std::span<const std::vector<TiltWitness>> frames,
                         std::span<const MeasuredTree> trees, double height, double tilt_sigma);

}  // namespace bole
