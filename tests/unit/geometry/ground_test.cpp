#include "geometry/ground.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/angles.h"

namespace bole {
namespace {

TEST(Ground, DistanceAndTangentAreInverse) {
  EXPECT_NEAR(ground_distance(ground_tangent(3.7, 1.05), 1.05), 3.7, 1e-12);
  EXPECT_NEAR(ground_distance(-1, 2), 2, 1e-12);
  EXPECT_TRUE(std::isinf(ground_distance(0, 1.05)));
  EXPECT_TRUE(std::isinf(ground_distance(0.1, 1.05)));
}

TEST(Ground, ATrunksFootAndWidthGiveItsDiameter) {
  for (const double diameter : {0.2, 0.8, 3.0}) {
    const double range = 4;
    const double width = angular_width(diameter, range);
    EXPECT_NEAR(std::sin(width / 2), diameter / (2 * range), 1e-12);
    EXPECT_NEAR(diameter_from_foot(range - diameter / 2, width), diameter, 1e-12);
  }
}

TEST(Ground, FromInsideATrunkItFillsTheView) { EXPECT_EQ(angular_width(2, 0.9), kPi); }

}  // namespace
}  // namespace bole
