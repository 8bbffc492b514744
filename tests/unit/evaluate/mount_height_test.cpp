#include "evaluate/mount_height.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "unit/evaluate/seen_trunk.h"

namespace bole {
namespace {

const cv::Matx22d kKnownTilt = 0.004 * 0.004 * cv::Matx22d::eye();
const cv::Matx22d kTilt = 0.02 * 0.02 * cv::Matx22d::eye();

// One frame of trunks of 0.3 m, 3 m away.
Frame frame_of(const std::vector<double>& bearings) {
  Frame frame;
  for (const double bearing : bearings) frame.push_back(seen_through({}, bearing, 3, 0.3));
  return frame;
}

double sigma_by(const std::vector<double>& bearings, const cv::Matx22d& tilt) {
  const std::vector<Frame> frames = {frame_of(bearings)};
  std::vector<MeasuredTree> trees;
  for (const double bearing : bearings) trees.push_back({bearing, 3});
  return estimate_height(frames, trees, kHeight, tilt).sigma;
}

TEST(MountHeight, FollowsFromMeasuredTrees) {
  std::vector<Frame> frames(3);
  for (Frame& frame : frames) {
    frame.push_back(seen_through({}, 0.5, 3, 0.3));
    frame.push_back(seen_through({}, -2, 4, 0.4));
  }
  const std::vector<MeasuredTree> trees = {{0.49, 3}, {-2.01, 4}};
  const Measured height = estimate_height(frames, trees, 0.9 * kHeight, kKnownTilt);
  EXPECT_NEAR(height.value, kHeight, 1e-3);
  EXPECT_GT(height.sigma, 0.01);
  EXPECT_LT(height.sigma, 0.1);
}

TEST(MountHeight, IsRefusedWhereNoTrunkStandsAtAMeasuredBearing) {
  const std::vector<Frame> frames = {{seen_through({}, 0.5, 3, 0.3)}};
  const std::vector<MeasuredTree> trees = {{0.6, 3}};
  EXPECT_THROW(estimate_height(frames, trees, kHeight, kKnownTilt), std::runtime_error);
}

TEST(MountHeight, SharesTheTiltsErrorAmongTreesOnOneSide) {
  const double one = sigma_by({0}, kTilt), side = sigma_by({-0.1, 0, 0.1, 0.2}, kTilt),
               round = sigma_by({0, kPi / 2, kPi, -kPi / 2}, kTilt);
  EXPECT_GT(side, 0.8 * one);
  EXPECT_LT(round, 0.3 * one);
}

TEST(MountHeight, GoesByTheTiltTowardsItsTree) {
  const cv::Matx22d nods(0.02 * 0.02, 0, 0, 0);
  EXPECT_GT(sigma_by({0}, nods), 2 * sigma_by({kPi / 2}, nods));
}

}  // namespace
}  // namespace bole
