#include "geometry/mount.h"

#include <algorithm>
#include <cmath>

namespace bole {
namespace {

// OCamCalib: x grows down the image, y to its right.
Vec3 ocam_axis(ImageSide side) {
  switch (side) {
    case ImageSide::up:
      return {-1, 0, 0};
    case ImageSide::down:
      return {1, 0, 0};
    case ImageSide::left:
      return {0, -1, 0};
    case ImageSide::right:
      break;
  }
  return {0, 1, 0};
}

Mat3 small_rotation(const Mount& mount) {
  return rotation_z(mount.yaw) * rotation_y(mount.pitch) * rotation_x(mount.roll);
}

}  // namespace

Mat3 robot_from_omni_camera(const Mount& mount) {
  const Vec3 up{0, 0, mount.centre_looks_down ? 1.0 : -1.0};
  return small_rotation(mount) * Mat3{{ocam_axis(mount.forward), ocam_axis(mount.left), up}};
}

Mat3 robot_from_omni_opencv_camera(const Mount& mount) {
  constexpr Mat3 kOcamFromOpencv{{Vec3{0, 1, 0}, Vec3{1, 0, 0}, Vec3{0, 0, -1}}};
  return robot_from_omni_camera(mount) * kOcamFromOpencv;
}

Mat3 robot_from_forward_camera(const Mount& mount) {
  return small_rotation(mount) * Mat3{{Vec3{0, 0, 1}, Vec3{-1, 0, 0}, Vec3{0, -1, 0}}};
}

// After the roll the ray has a forward and an upward part; the pitch turns the latter into zero.
double pitch_of_forward_camera(const Vec3& ray, double roll) {
  const double up = -ray.x * std::sin(roll) - ray.y * std::cos(roll);
  return std::atan2(up, ray.z);
}

Vec3 level_ray_of_forward_camera(const Mount& mount) {
  const Vec3 up = robot_from_forward_camera(mount).rows[2];
  return normalized({0, up.y < 0 ? up.z : -up.z, std::abs(up.y)});
}

Mount levelled(const Mount& mount, const Vec3& up) {
  const Vec3 v = normalized(transposed(small_rotation(mount)) * up);
  Mount result = mount;
  result.pitch = std::asin(std::clamp(-v.x, -1.0, 1.0));
  result.roll = std::atan2(v.y, v.z);
  return result;
}

}  // namespace bole
