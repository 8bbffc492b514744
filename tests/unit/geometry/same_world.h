#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "geometry/camera_model.h"
#include "geometry/mount.h"
#include "geometry/ocam.h"

namespace bole {

inline constexpr double kWholeImage = std::numeric_limits<double>::infinity();

/// One camera of 1280 x 960 about (470, 650), once in OpenCV's form and once in OCamCalib's, sees
/// the same up to `radius` pixels from there, whether its middle looks down or up.
inline void expect_same_world(const CameraModel& opencv, const OcamModel& ocam, ImageSide forward,
                              ImageSide left, double radius, double tolerance) {
  for (const bool down : {true, false}) {
    const Mount mount{.forward = forward,
                      .left = left,
                      .centre_looks_down = down,
                      .roll = 0.03,
                      .pitch = -0.05,
                      .yaw = 0.4};
    for (double row = 0; row < 960; row += 53) {
      for (double column = 0; column < 1280; column += 47) {
        if (std::hypot(row - 470, column - 650) > radius) continue;
        const Vec3 a = robot_from_omni_camera(mount) * ocam.ray_from_pixel({row, column});
        const Vec3 b = robot_from_omni_opencv_camera(mount) * opencv.ray_from_pixel({row, column});
        ASSERT_NEAR(a.x, b.x, tolerance);
        ASSERT_NEAR(a.y, b.y, tolerance);
        ASSERT_NEAR(a.z, b.z, tolerance);
      }
    }
  }
}

}  // namespace bole
