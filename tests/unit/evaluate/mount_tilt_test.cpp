#include "evaluate/mount_tilt.h"

#include <gtest/gtest.h>

#include <cmath>

#include "detect/ground_tilt.h"
#include "geometry/angles.h"
#include "geometry/mount.h"
#include "unit/evaluate/seen_trunk.h"

namespace bole {
namespace {

// Trees all round, or within `arc` about forward; not one is the same in two frames.
std::vector<Frame> wood(const Mat3& seen, int frames, double arc = 2 * kPi) {
  std::vector<Frame> result(frames);
  for (int i = 0; i < 12 * frames; ++i) {
    const double bearing = arc * (std::fmod(0.618034 * i, 1.0) - 0.5);
    const double range = 2 + 1.1 * (i % 7), diameter = 0.2 + 0.05 * (i % 5);
    result[i % frames].push_back(seen_through(seen, bearing, range, diameter));
  }
  return result;
}

// What is seen of a camera that is mounted as `truth` says where `said` is believed.
Mat3 seen_with(const Mat3& said, const Mat3& truth) { return said * transposed(truth); }

Vec3 up_of(const cv::Vec2d& tilt) { return {-tilt[0], -tilt[1], 1}; }

double sigma(const TiltFigure& figure, int axis) {
  return std::sqrt(figure.covariance(axis, axis));
}

TEST(MountTilt, IsNoneOfAMountThatIsTrue) {
  const MountTilt found = estimate_mount_tilt(wood({}, 20), kHeight);
  EXPECT_NEAR(found.both.tilt[0], 0, 0.003);
  EXPECT_NEAR(found.both.tilt[1], 0, 0.003);
  EXPECT_LT(sigma(found.both, 0), 0.006);
}

TEST(MountTilt, LeadsToTheTrueMountWhateverTheImagesSides) {
  for (const bool mirrored : {false, true}) {
    for (const bool down : {true, false}) {
      const Mount truth{.left = mirrored ? ImageSide::right : ImageSide::left,
                        .centre_looks_down = down,
                        .roll = radians(1.5),
                        .pitch = radians(-2),
                        .yaw = radians(70)};
      Mount said = truth;
      said.roll += radians(-3);
      said.pitch += radians(2);
      for (int round = 0; round < 4; ++round) {
        const Mat3 seen = seen_with(robot_from_omni_camera(said), robot_from_omni_camera(truth));
        const MountTilt found = estimate_mount_tilt(wood(seen, 20), kHeight);
        said = levelled(said, up_of(found.both.tilt));
      }
      EXPECT_NEAR(degrees(said.roll), 1.5, 0.1) << mirrored << down;
      EXPECT_NEAR(degrees(said.pitch), -2, 0.1) << mirrored << down;
      EXPECT_EQ(said.yaw, truth.yaw);
    }
  }
}

TEST(MountTilt, LeadsToTheTrueMountOfACameraThatLooksAhead) {
  const Mount truth{.roll = radians(1), .pitch = radians(4)};
  Mount said{.roll = radians(-1), .pitch = radians(2)};
  for (int round = 0; round < 4; ++round) {
    const Mat3 seen = seen_with(robot_from_forward_camera(said), robot_from_forward_camera(truth));
    const MountTilt found = estimate_mount_tilt(wood(seen, 20, radians(60)), kHeight);
    said = levelled(said, up_of(found.both.tilt));
  }
  EXPECT_NEAR(degrees(said.roll), 1, 0.2);
  EXPECT_NEAR(degrees(said.pitch), 4, 0.5);
}

TEST(MountTilt, IsVagueWhereNoTrunkTells) {
  // Trunks in one direction say by their lean how the camera tilts to the side, hardly how it
  // nods.
  const MountTilt found = estimate_mount_tilt(wood({}, 20, radians(4)), kHeight);
  EXPECT_GT(sigma(found.by_lean, 0), 0.05);
  EXPECT_LT(sigma(found.by_lean, 1), 0.01);
  const MountTilt none = estimate_mount_tilt({}, kHeight);
  EXPECT_EQ(none.trunks, 0);
  EXPECT_GT(sigma(none.both, 0), 0.05);
}

TEST(MountTilt, CountsATrunkOnceHoweverManyFramesShowIt) {
  const std::vector<Frame> one = wood({}, 1), stand(30, one.front());
  const MountTilt once = estimate_mount_tilt(one, kHeight);
  const MountTilt often = estimate_mount_tilt(stand, kHeight);
  EXPECT_EQ(once.trunks, 12);
  EXPECT_EQ(often.trunks, 12);
  EXPECT_NEAR(sigma(often.both, 0), sigma(once.both, 0), 0.1 * sigma(once.both, 0));
}

TEST(MountTilt, IsHardlyMovedByCrookedTreesAndHiddenFeet) {
  std::vector<Frame> frames = wood({}, 20);
  for (Frame& frame : frames) {
    frame[0].lean += 0.14;
    frame[1].sight.down = 0.02;
  }
  const MountTilt found = estimate_mount_tilt(frames, kHeight);
  EXPECT_LT(cv::norm(found.both.tilt), 0.005);
}

}  // namespace
}  // namespace bole
