#pragma once

#include "geometry/rotation.h"

namespace bole {

/// A direction in the raw image.
enum class ImageSide { up, down, left, right };

/// How the camera sits on the robot.
struct Mount {
  double height = 1.0;                  ///< metres, viewpoint above the ground
  ImageSide forward = ImageSide::up;    ///< where the robot's forward lies in the image
  ImageSide left = ImageSide::left;     ///< where its left lies: a mirror image has them swapped
  bool centre_looks_down = true;        ///< what the middle of the image sees; else up
  double roll = 0, pitch = 0, yaw = 0;  ///< radians; positive pitch looks down
};

/// The robot frame (x forward, y left, z up) from the frame of an omnidirectional camera in
/// OCamCalib's axes: Rz(yaw) Ry(pitch) Rx(roll) after the axes have been named by the image's
/// sides. Its determinant is -1 where the camera's handedness differs, as under a mirror.
Mat3 robot_from_omni_camera(const Mount& mount);

/// The same for an omnidirectional camera in OpenCV's axes: x right in the image, y down, z along
/// the optical axis, which is what the middle of the image sees.
Mat3 robot_from_omni_opencv_camera(const Mount& mount);

/// The same for a camera that looks ahead, in OpenCV's axes (x right, y down, z forward); the
/// mount's sides are not used.
Mat3 robot_from_forward_camera(const Mount& mount);

/// The pitch of a camera that looks ahead, mounted with `roll`, for which `ray` (in the camera's
/// own frame) is level.
double pitch_of_forward_camera(const Vec3& ray, double roll);

/// The inverse: the ray (in the camera's own frame) that is level and lies in the plane of the
/// optical axis and the image's column, where the image's horizon crosses its middle column.
Vec3 level_ray_of_forward_camera(const Mount& mount);

/// The mount with the roll and pitch under which `up`, a direction in the robot frame that `mount`
/// leads to, is the vertical; yaw, height and sides stay. With S = Ry(pitch) Rx(roll), the third
/// row of the new S is the vertical as it stands between the sides and the rotations, S' Rz(-yaw)
/// up.
Mount levelled(const Mount& mount, const Vec3& up);

}  // namespace bole
