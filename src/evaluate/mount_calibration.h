#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evaluate/mount_height.h"
#include "evaluate/mount_tilt.h"
#include "warp/camera_files.h"

namespace bole {

/// An image of no use, and why.
struct LeftOut {
  std::filesystem::path file;
  std::string error;
};

/// What the trunks in many frames say of a camera's mount.
struct MountCalibration {
  Measured roll, pitch;                 ///< radians
  std::optional<Measured> horizon_row;  ///< of a camera that has one
  std::optional<Measured> height;       ///< metres; none: no tree was measured
  /// What tilt the trunks' lean still tells of that mount, less what their feet tell.
  TiltFigure lean_against_feet;
  int frames = 0, trunks = 0;
  std::vector<LeftOut> left_out;
  std::vector<std::string> warnings;  ///< why the result may be worse than it says, and what helps
};

/// The mount of `camera`, which is left with it, from images of trunks, in the order in which they
/// were taken: trunks stand upright, and their feet on level ground. What is found is put into the
/// warp table and looked for again until next to nothing is left of it. Where trees are measured,
/// the robot stood still for all images, and estimate_height gives the height. `progress` is told
/// frames done and all, in each round anew. Throws std::runtime_error, with the remedy, when no
/// image is of use (telling why the first is not), the trunks are too few or on one side only, or a
/// measured tree is not found.
MountCalibration calibrate_mount(Camera& camera, std::span<const std::filesystem::path> images,
                                 std::span<const MeasuredTree> trees,
                                 const std::function<void(int, int)>& progress);

/// The mount under which no tilt is left, searched from `mount` on: `tilt_under` tells the tilt (as
/// TiltFigure's) that is seen under a mount, last under the one that is returned. Nearly there,
/// what trunks are found, and how they lean, changes by chance with every bit of the mount: so the
/// last estimates are averaged, the n-th of them followed by 1 / n.
Mount settled(Mount mount, const std::function<cv::Vec2d(const Mount&)>& tilt_under);

/// The row of a forward camera's horizon in the image's middle column, where its pitch is known to
/// `pitch_sigma` radians. Throws std::runtime_error when the lens does not show it.
Measured horizon_row_of(const Camera& camera, double pitch_sigma);

}  // namespace bole
