#include "evaluate/mount_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/angles.h"
#include "unit/warp/test_cameras.h"

namespace bole {
namespace {

using testing::HasSubstr;

// The tilt under a mount whose roll and pitch should be 1 and -2 degrees.
cv::Vec2d tilt_under(const Mount& mount) {
  return {radians(-2) - mount.pitch, mount.roll - radians(1)};
}

TEST(MountCalibration, ComesToTheMountFromAfar) {
  Mount asked_last;
  const Mount found = settled({.roll = radians(-5), .pitch = radians(4)}, [&](const Mount& mount) {
    asked_last = mount;
    return 0.7 * tilt_under(mount);
  });
  EXPECT_NEAR(degrees(found.roll), 1, 0.1);
  EXPECT_NEAR(degrees(found.pitch), -2, 0.1);
  EXPECT_EQ(asked_last.roll, found.roll);
  EXPECT_EQ(asked_last.pitch, found.pitch);
}

TEST(MountCalibration, AveragesEstimatesThatGoToAndFro) {
  for (const double by : {0.15, 0.5}) {
    int round = 0;
    const Mount found = settled({}, [&](const Mount& mount) {
      const double chance = radians(round++ % 2 == 0 ? by : -by);
      return tilt_under(mount) + cv::Vec2d(chance, chance);
    });
    EXPECT_NEAR(degrees(found.roll), 1, 0.1);
    EXPECT_NEAR(degrees(found.pitch), -2, 0.1);
    EXPECT_LT(round, 12);
  }
}

TEST(MountCalibration, GivesTheHorizonsRowAndItsSigma) {
  const test::TemporaryFolder folder;
  const Camera camera = load_camera(write_pinhole(folder));
  const Measured row = horizon_row_of(camera, radians(1));
  EXPECT_NEAR(row.value, 50, 1e-6);
  const double focal = 80 / std::tan(radians(30));
  EXPECT_NEAR(row.sigma, focal * radians(1), 0.05);
}

TEST(MountCalibration, RefusesAHorizonThatTheLensCannotShow) {
  const test::TemporaryFolder folder;
  Camera camera = load_camera(write_pinhole(folder));
  Mount mount = camera.config.mount;
  mount.roll = radians(90);
  remount(camera, mount);
  try {
    horizon_row_of(camera, radians(1));
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("mend horizon_row and roll_deg"));
  }
}

TEST(MountCalibration, TellsWhyNoImageIsOfUse) {
  const test::TemporaryFolder folder;
  Camera camera = load_camera(write_small_camera(folder));
  const std::vector<std::filesystem::path> images = {folder.write("a.jpg", "no picture"),
                                                     folder.write("b.yuyv", "short")};
  try {
    calibrate_mount(camera, images, {}, [](int, int) {});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("of 2 images 2 could not be used"));
    EXPECT_THAT(error.what(), HasSubstr("a.jpg: is no image"));
  }
}

}  // namespace
}  // namespace bole
