#include "detect/ground_tilt.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "geometry/ground.h"

namespace bole {
namespace {

constexpr double kHeight = 1.2;

// Upright trees all round, seen by a camera that is tilted, or on ground that slopes.
std::vector<TiltWitness> wood(int count, const GroundTilt& ground, const GroundTilt& camera) {
  std::vector<TiltWitness> witnesses;
  for (int i = 0; i < count; ++i) {
    const double bearing = 2.4 * i, range = 2 + 1.7 * (i % 7), diameter = 0.2 + 0.06 * (i % 5);
    witnesses.push_back({.bearing = bearing,
                         .sight = {.down = kHeight / (range - diameter / 2) - ground.raise(bearing),
                                   .down_sigma = 0.003,
                                   .angular_width = angular_width(diameter, range)},
                         .lean = camera.lean(bearing) + 0.02 * std::sin(5.0 * i),
                         .weight = 0.9});
  }
  return witnesses;
}

void expect_near(const GroundTilt& tilt, const GroundTilt& truth, double tolerance) {
  EXPECT_NEAR(tilt.forward, truth.forward, tolerance);
  EXPECT_NEAR(tilt.left, truth.left, tolerance);
}

TEST(TiltEstimator, TrustsTheMountWhereTheTreesDoNotSpeakAgainstIt) {
  expect_near(TiltEstimator(kHeight).estimate(wood(15, {}, {})), {}, 0);
}

TEST(TiltEstimator, FindsThreeDegreesOfTiltFromFeetAndLean) {
  TiltEstimator estimator(kHeight);
  for (const GroundTilt tilt : {GroundTilt{0.052, 0}, {-0.052, 0}, {0, 0.052}, {0.04, -0.04}})
    expect_near(estimator.estimate(wood(15, tilt, tilt)), tilt, 0.02);
}

TEST(TiltEstimator, FindsASlopeFromFeetAlone) {
  const GroundTilt slope{0.1, 0.05};
  expect_near(TiltEstimator(kHeight).estimate(wood(25, slope, {})), slope, 0.04);
}

TEST(TiltEstimator, FindsSteepSlopesWhereverTheyRise) {
  TiltEstimator estimator(kHeight);
  for (int i = 0; i < 8; ++i) {
    const GroundTilt slope{0.18 * std::cos(0.8 * i), 0.18 * std::sin(0.8 * i)};
    expect_near(estimator.estimate(wood(25, slope, {})), slope, 0.05);
  }
}

TEST(TiltEstimator, SaysThatItKnowsLessOfATiltThanTheMountOfNone) {
  const GroundTilt tilt{0.052, 0};
  TiltEstimator estimator(kHeight);
  EXPECT_EQ(estimator.estimate(wood(15, {}, {})).sigma, 0);
  EXPECT_GT(estimator.estimate(wood(15, tilt, tilt)).sigma, 0.01);
}

TEST(TiltEstimator, SaysNothingOnTwoTrees) {
  const GroundTilt tilt{0.052, 0};
  expect_near(TiltEstimator(kHeight).estimate(wood(2, tilt, tilt)), {}, 0);
}

TEST(TiltEstimator, TakesCrookedTreesForCrookedTrees) {
  std::vector<TiltWitness> witnesses = wood(15, {}, {});
  for (std::size_t i = 0; i < witnesses.size(); i += 5) witnesses[i].lean += 0.15;
  expect_near(TiltEstimator(kHeight).estimate(witnesses), {}, 0);
}

TEST(GroundTilt, RaisesTheGroundAheadAndLeansTrunksAtTheSides) {
  const GroundTilt up{0.05, 0};
  EXPECT_NEAR(up.raise(0), 0.05, 1e-12);
  EXPECT_NEAR(up.raise(M_PI / 2), 0, 1e-12);
  EXPECT_NEAR(up.lean(0), 0, 1e-12);
  EXPECT_NEAR(std::abs(up.lean(M_PI / 2)), 0.05, 1e-12);
}

}  // namespace
}  // namespace bole
