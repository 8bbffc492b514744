#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "geometry/camera_config.h"
#include "geometry/camera_model.h"
#include "geometry/rotation.h"

namespace bole {

/// One camera as its folder describes it: camera.toml and the files that it names.
struct Camera {
  std::filesystem::path file;  ///< camera.toml
  CameraConfig config;
  std::unique_ptr<const CameraModel> model;
  Mat3 robot_from_camera;
  std::vector<std::uint8_t> mask;  ///< row by row, 0 = never look here; empty: look everywhere
  std::string config_text;         ///< camera.toml as it is
  std::string calibration_text;    ///< the calibration file as it is; empty without one
  std::uint32_t digest =
      0;  ///< CRC-32 over camera.toml, calibration and mask: what a table is bound to
};

/// The mask that camera.toml names; empty: none.
std::filesystem::path mask_file(const Camera& camera);

/// Reads camera.toml, the calibration and the mask, and checks that they fit each other. Throws
/// ConfigError for whatever is missing, damaged or does not fit.
Camera load_camera(const std::filesystem::path& camera_toml);

/// Holds the camera otherwise. Its digest stays: tables made from now on are not for the cache.
void remount(Camera& camera, const Mount& mount);

}  // namespace bole
