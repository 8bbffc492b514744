#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/image.h"
#include "base/toml_table.h"
#include "geometry/mount.h"
#include "geometry/panorama.h"

namespace bole {

/// What the detector looks for.
struct Search {
  Bounds range{1.0, 8.0};     ///< metres from the camera's axis to the trunk's
  Bounds diameter{0.2, 0.8};  ///< metres
};

/// camera.toml: a camera, its mount, the panorama made of it, and the trees looked for in it.
struct CameraConfig {
  enum class Model { ocam, fisheye, omnidir, pinhole };
  Model model = Model::ocam;
  std::string calibration;            ///< file name, relative to camera.toml's folder; empty: none
  std::string mask;                   ///< file name, likewise
  double horizontal_fov = 0;          ///< radians; a pinhole without a calibration
  ImageSize size;                     ///< the same, or of a calibration that does not say it
  std::optional<double> horizon_row;  ///< of a pinhole, in place of the mount's pitch
  Mount mount;  ///< its pitch, where horizon_row stands for it, is load_camera's to find
  int columns = 1440;
  double elevation_top = 0;  ///< radians
  double range_min = 0.9;    ///< metres: the panorama's lower border
  Search search;
};

/// As camera.toml writes it.
std::string_view name_of(CameraConfig::Model model);

/// Mounted by the sides of its image, where a pinhole looks ahead.
bool looks_all_round(CameraConfig::Model model);

/// Parses camera.toml's text. Every key is checked (known, of its type, in range, and fitting the
/// others); throws ConfigError naming `file` and the key.
CameraConfig parse_camera_config(std::string_view text, const std::string& file);

/// The full panorama that the configuration asks for.
PanoramaGeometry panorama_of(const CameraConfig& config);

}  // namespace bole
