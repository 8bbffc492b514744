#pragma once

#include <cstdint>
#include <filesystem>

#include "warp/camera_files.h"

namespace bole::simulate {

/// Invents a plausible omnidirectional camera and its mount, writes its files (camera.toml,
/// calib_results.txt, mask.png) into `folder` and loads them: a curved mirror (mirrored image or
/// not), a fisheye that looks down, or one that looks up; 0.5 to 1.8 m above the ground, tilted by
/// up to 3 degrees, turned by any angle; 480 to 1200 rows; a mask with the robot, the lens's border
/// and sometimes the rods that hold a mirror. The same seed gives the same bytes.
Camera invent_camera(const std::filesystem::path& folder, std::uint64_t seed);

}  // namespace bole::simulate
