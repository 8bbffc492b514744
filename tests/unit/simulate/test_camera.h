#pragma once

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include "geometry/ocam.h"
#include "warp/camera_files.h"

namespace bole {

/// A catadioptric camera of `width` x 3/4 `width` pixels that sees from 50 degrees below to 30
/// degrees above the horizon, with the given lines in the mount's table of its camera.toml. Its
/// files exist in memory only.
inline Camera test_camera(int width, const std::string& mount) {
  const double scale = width / 1280.0;
  const int height = width * 3 / 4;
  char calibration[512];
  (void)std::snprintf(calibration, sizeof calibration,
                      "4 %.9g 0 %.9g %.9g\n2 0 0\n%.9g %.9g\n0.9996 0.0002 -0.0002\n%d %d\n",
                      -190.3 * scale, 1.9e-3 / scale, 3e-7 / (scale * scale), 0.502 * height,
                      0.499 * width, height, width);
  Camera camera;
  camera.calibration_text = calibration;
  camera.config_text =
      "[camera]\nmodel = \"ocam\"\ncalibration = \"calib_results.txt\"\n[mount]\n" + mount;
  camera.config = parse_camera_config(camera.config_text, "camera.toml");
  auto model = std::make_unique<OcamModel>(parse_ocam(calibration, "calib_results.txt"));
  camera.robot_from_camera = robot_from_omni_camera(camera.config.mount);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const Vec3 ray =
          model->ray_from_pixel({static_cast<double>(row), static_cast<double>(column)});
      const double tangent = ray.z / std::hypot(ray.x, ray.y);
      camera.mask.push_back(tangent > -1.2 && tangent < 0.58 ? 255 : 0);
    }
  }
  camera.model = std::move(model);
  return camera;
}

}  // namespace bole
