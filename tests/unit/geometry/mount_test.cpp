#include "geometry/mount.h"

#include <gtest/gtest.h>

#include "geometry/angles.h"

namespace bole {
namespace {

void expect_near(const Vec3& a, const Vec3& b) {
  EXPECT_NEAR(a.x, b.x, 1e-12);
  EXPECT_NEAR(a.y, b.y, 1e-12);
  EXPECT_NEAR(a.z, b.z, 1e-12);
}

double determinant(const Mat3& m) {
  const auto& [a, b, c] = m.rows;
  return a.x * (b.y * c.z - b.z * c.y) - a.y * (b.x * c.z - b.z * c.x) +
         a.z * (b.x * c.y - b.y * c.x);
}

// OCamCalib's rays: x down the image, y to its right.
constexpr Vec3 kImageUp{-1, 0, 0}, kImageLeft{0, -1, 0}, kImageRight{0, 1, 0};

TEST(Mount, OfACameraThatLooksDownLeftIsLeft) {
  const Mat3 r = robot_from_omni_camera({});
  expect_near(r * kImageUp, {1, 0, 0});
  expect_near(r * kImageLeft, {0, 1, 0});
  expect_near(r * Vec3{0, 0, -1}, {0, 0, -1});  // the middle sees the ground
}

TEST(Mount, UnderAMirrorTheWorldIsMirrored) {
  const Mat3 r = robot_from_omni_camera({.left = ImageSide::right});
  expect_near(r * kImageUp, {1, 0, 0});
  expect_near(r * kImageRight, {0, 1, 0});
  EXPECT_NEAR(determinant(r) * determinant(robot_from_omni_camera({})), -1, 1e-12);
}

TEST(Mount, OfACameraThatLooksUpTheMiddleSeesTheSky) {
  const Mat3 r = robot_from_omni_camera({.left = ImageSide::right, .centre_looks_down = false});
  expect_near(r * Vec3{0, 0, -1}, {0, 0, 1});
}

TEST(Mount, ForwardMayLieOnAnySideOfTheImage) {
  const Mat3 r = robot_from_omni_camera({.forward = ImageSide::right, .left = ImageSide::up});
  expect_near(r * kImageRight, {1, 0, 0});
  expect_near(r * kImageUp, {0, 1, 0});
}

TEST(Mount, PositivePitchLooksDownPositiveRollLiftsTheLeftPositiveYawTurnsLeft) {
  const Vec3 forward = kImageUp, left = kImageLeft;
  EXPECT_NEAR((robot_from_omni_camera({.pitch = 0.1}) * forward).z, -std::sin(0.1), 1e-12);
  EXPECT_NEAR((robot_from_omni_camera({.roll = 0.1}) * left).z, std::sin(0.1), 1e-12);
  EXPECT_NEAR((robot_from_omni_camera({.yaw = 0.1}) * forward).y, std::sin(0.1), 1e-12);
}

TEST(Mount, RollComesFirstThenPitchThenYaw) {
  const Mount mount{.roll = 0.3, .pitch = -0.2, .yaw = 1.1};
  const Vec3 v{0.2, -0.5, 0.7};
  const Vec3 expected =
      rotation_z(1.1) * (rotation_y(-0.2) * (rotation_x(0.3) * (robot_from_omni_camera({}) * v)));
  expect_near(robot_from_omni_camera(mount) * v, expected);
}

// OpenCV's rays: x to the image's right, y down it, z along the axis.
TEST(Mount, NamesOpenCvsAxesByTheImagesSidesToo) {
  const Vec3 image_up{0, -1, 0}, image_left{-1, 0, 0}, axis{0, 0, 1};
  const Mat3 down = robot_from_omni_opencv_camera({});
  expect_near(down * image_up, {1, 0, 0});
  expect_near(down * image_left, {0, 1, 0});
  expect_near(down * axis, {0, 0, -1});
  EXPECT_NEAR(determinant(down), 1, 1e-12);
  const Mat3 up =
      robot_from_omni_opencv_camera({.left = ImageSide::right, .centre_looks_down = false});
  expect_near(up * image_up, {1, 0, 0});
  expect_near(up * image_left, {0, -1, 0});
  expect_near(up * axis, {0, 0, 1});
  EXPECT_NEAR(determinant(up), 1, 1e-12);  // no mirror
  const Mat3 mirror = robot_from_omni_opencv_camera({.left = ImageSide::right});
  expect_near(mirror * axis, {0, 0, -1});
  EXPECT_NEAR(determinant(mirror), -1, 1e-12);
}

// What a fisheye that looks ahead needs: the axis turns from the ground to the front.
TEST(Mount, APitchOfMinusNinetyDegreesTurnsACameraThatLooksDownAhead) {
  const Mat3 r = robot_from_omni_opencv_camera({.pitch = radians(-90)});
  expect_near(r * Vec3{0, 0, 1}, {1, 0, 0});
  expect_near(r * Vec3{0, -1, 0}, {0, 0, 1});
  expect_near(r * Vec3{-1, 0, 0}, {0, 1, 0});
}

TEST(Mount, OfACameraThatLooksAheadTheImagesLeftIsTheRobotsLeft) {
  const Mat3 r = robot_from_forward_camera({.forward = ImageSide::down});  // sides do not matter
  expect_near(r * Vec3{0, 0, 1}, {1, 0, 0});
  expect_near(r * Vec3{-1, 0, 0}, {0, 1, 0});
  expect_near(r * Vec3{0, 1, 0}, {0, 0, -1});
}

TEST(Mount, ThePitchOfTheHorizonMakesItsRayLevel) {
  for (const double roll : {0.0, 0.2, -0.4}) {
    for (const Vec3& ray : {Vec3{0, 0.2, 1}, Vec3{0.1, -0.3, 0.9}}) {
      const double pitch = pitch_of_forward_camera(ray, roll);
      EXPECT_NEAR((robot_from_forward_camera({.roll = roll, .pitch = pitch}) * ray).z, 0, 1e-12);
    }
  }
  // A horizon below the image's middle: the camera looks up.
  EXPECT_LT(pitch_of_forward_camera({0, 0.2, 1}, 0), 0);
}

TEST(Mount, TheLevelRayOfACameraThatLooksAheadLiesInItsMiddleColumn) {
  for (const double roll : {0.0, 0.2, -0.4}) {
    for (const double pitch : {0.0, 0.3, -0.1}) {
      const Mount mount{.roll = roll, .pitch = pitch};
      const Vec3 ray = level_ray_of_forward_camera(mount);
      EXPECT_EQ(ray.x, 0);
      EXPECT_GT(ray.z, 0);
      EXPECT_NEAR((robot_from_forward_camera(mount) * ray).z, 0, 1e-12);
      EXPECT_NEAR(pitch_of_forward_camera(ray, roll), pitch, 1e-12);
    }
  }
}

// Whatever the true mount: what it says is up, seen through the wrong mount, leads back to it.
TEST(Mount, IsLevelledByWhatIsUp) {
  for (const bool mirrored : {false, true}) {
    for (const bool down : {true, false}) {
      const ImageSide left = mirrored ? ImageSide::right : ImageSide::left;
      for (const double yaw : {0.0, 2.2, -1.3}) {
        const Mount truth{
            .left = left, .centre_looks_down = down, .roll = 0.05, .pitch = -0.03, .yaw = yaw};
        Mount wrong = truth;
        wrong.roll -= 0.08;
        wrong.pitch += 0.06;
        const Vec3 up = robot_from_omni_camera(wrong) *
                        (transposed(robot_from_omni_camera(truth)) * Vec3{0, 0, 1});
        const Mount mended = levelled(wrong, up);
        EXPECT_NEAR(mended.roll, truth.roll, 1e-12);
        EXPECT_NEAR(mended.pitch, truth.pitch, 1e-12);
        EXPECT_EQ(mended.yaw, yaw);
      }
    }
  }
}

}  // namespace
}  // namespace bole
