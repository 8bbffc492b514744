#include <cmath>

#include <gtest/gtest.h>

#include "evaluate/pixel_rates.h"
#include "evaluate/reliability.h"
#include "evaluate/tracking_figures.h"
#include "geometry/angles.h"
#include "geometry/ground.h"

namespace bole {
namespace {

constexpr double kHeight = 1;

TruthTree marked(int id, double bearing, double range, double diameter = 0.4) {
  return {.id = id, .bearing = bearing, .range = range, .diameter = diameter, .visible = 1};
}

Tree found(int id, double bearing, double range, double score = 0.9, double diameter = 0.4) {
  return {.id = id,
          .bearing = static_cast<float>(bearing),
          .range = static_cast<float>(range),
          .diameter = static_cast<float>(diameter),
          .score = static_cast<float>(score),
          .range_sigma = 0.1F,
          .base_elevation = static_cast<float>(std::atan2(-kHeight, range - diameter / 2)),
          .angular_width = static_cast<float>(angular_width(diameter, range))};
}

Truth truth_of(const std::vector<std::vector<TruthTree>>& frames) {
  Truth truth{.height = kHeight, .frames = {}};
  for (const auto& trees : frames) {
    truth.frames.push_back(
        {.file = std::to_string(truth.frames.size()), .metric = true, .trees = trees});
  }
  return truth;
}

Detections detections_of(const std::vector<std::vector<Tree>>& frames) {
  Detections detections;
  for (const auto& trees : frames) detections[std::to_string(detections.size())] = trees;
  return detections;
}

TEST(Reliability, IsPerfectWhereSharesAreScores) {
  std::vector<Outcome> outcomes;
  for (int k = 0; k < 100; ++k) outcomes.push_back({0.75, k < 75});
  for (int k = 0; k < 100; ++k) outcomes.push_back({0.25, k < 25});
  EXPECT_NEAR(measure_reliability(outcomes).calibration_error, 0, 1e-12);
}

TEST(Reliability, WeighsErrorsByDetections) {
  // Nine detections that promise 0.95 and never hold it, one that promises 0.15 and is true.
  std::vector<Outcome> outcomes(9, {0.95, false});
  outcomes.push_back({0.15, true});
  const Reliability r = measure_reliability(outcomes);
  EXPECT_NEAR(r.calibration_error, (9 * 0.95 + 0.85) / 10, 1e-12);
  EXPECT_EQ(r.bins[9].count, 9);
  EXPECT_EQ(r.bins[1].hit_share, 1);
}

TEST(Reliability, PutsAScoreOfOneIntoTheLastBin) {
  const std::vector<Outcome> outcomes = {{1, true}};
  EXPECT_EQ(measure_reliability(outcomes).bins[9].count, 1);
}

TEST(RangeTrust, CountsTrueRangesWithinTwoSigma) {
  const Truth truth = truth_of({{marked(0, 0, 4), marked(1, 1, 4)}});
  const Detections trees = detections_of({{found(0, 0, 4.19), found(1, 1, 4.21)}});
  const RangeTrust trust = measure_range_trust(truth, trees, 0.5);
  EXPECT_EQ(trust.count, 2);
  EXPECT_EQ(trust.share_within_2_sigma, 0.5);
}

class PixelRatesTest : public testing::Test {
 protected:
  PixelRates measure(const Truth& truth, const Detections& detections) const {
    return measure_pixel_rates(truth, detections, panorama_, 0.5);
  }
  const PanoramaGeometry panorama_ = full_panorama(720, radians(27), 0.9, kHeight);
};

TEST_F(PixelRatesTest, OfTheTruthItselfArePerfect) {
  const PixelRates rates = measure(truth_of({{marked(0, 0, 4), marked(1, kPi - 0.01, 2)}}),
                                   detections_of({{found(0, 0, 4), found(1, kPi - 0.01, 2)}}));
  EXPECT_NEAR(rates.curve.back().true_positive_rate, 1, 1e-3);
  EXPECT_NEAR(rates.curve.back().false_positive_rate, 0, 1e-3);
  EXPECT_NEAR(*rates.overlap, 1, 1e-2);
  EXPECT_EQ(rates.curve.front().true_positive_rate, 0);  // no score is 1
}

TEST_F(PixelRatesTest, DropWithTheThreshold) {
  const PixelRates rates =
      measure(truth_of({{marked(0, 0, 4), marked(1, 2, 4)}}),
              detections_of({{found(0, 0, 4, 0.9), found(1, 2, 4, 0.3), found(2, -2, 4, 0.3)}}));
  for (const PixelRates::Point& point : rates.curve) {
    const double found_share = point.min_score > 0.9 ? 0 : point.min_score > 0.3 ? 0.5 : 1;
    EXPECT_NEAR(point.true_positive_rate, found_share, 0.01) << point.min_score;
    EXPECT_EQ(point.false_positive_rate > 0, point.min_score <= 0.3) << point.min_score;
  }
}

TEST_F(PixelRatesTest, IgnoreTreesThatNeitherHelpNorHurt) {
  const PixelRates rates = measure(truth_of({{marked(0, 0, 4), marked(1, 2, 9)}}),
                                   detections_of({{found(0, 0, 4), found(1, 2, 9)}}));
  EXPECT_EQ(rates.curve.back().false_positive_rate, 0);
  EXPECT_NEAR(*rates.overlap, 1, 1e-2);
}

// Two trees 2 m apart over four frames.
Truth two_trees() {
  const std::vector<TruthTree> trees = {marked(7, 0, 4), marked(8, 0.5, 4)};
  return truth_of({trees, trees, trees, trees});
}

TEST(TrackingFigures, ArePerfectForConstantIds) {
  const std::vector<Tree> trees = {found(1, 0, 4), found(2, 0.5, 4)};
  const TrackingFigures f =
      measure_tracking(two_trees(), detections_of({trees, trees, trees, trees}), 0.5);
  EXPECT_EQ(f.idf1, 1);
  EXPECT_EQ(f.id_switches, 0);
  EXPECT_EQ(f.id_swaps, 0);
}

TEST(TrackingFigures, CountAnIdThatBeginsAnew) {
  const std::vector<Tree> before = {found(1, 0, 4), found(2, 0.5, 4)};
  const std::vector<Tree> after = {found(1, 0, 4), found(3, 0.5, 4)};
  const TrackingFigures f =
      measure_tracking(two_trees(), detections_of({before, before, before, after}), 0.5);
  EXPECT_NEAR(f.idf1, 2.0 * 7 / 16, 1e-12);
  EXPECT_EQ(f.id_switches, 1);
  EXPECT_EQ(f.id_swaps, 0);
}

TEST(TrackingFigures, CountSwapsBetweenDistantTrees) {
  const std::vector<Tree> before = {found(1, 0, 4), found(2, 0.5, 4)};
  const std::vector<Tree> after = {found(2, 0, 4), found(1, 0.5, 4)};
  const TrackingFigures f =
      measure_tracking(two_trees(), detections_of({before, before, after, after}), 0.5);
  EXPECT_EQ(f.id_swaps, 2);
  EXPECT_NEAR(f.idf1, 0.5, 1e-12);
}

TEST(TrackingFigures, MissedFramesCostIdf1) {
  const std::vector<Tree> trees = {found(1, 0, 4), found(2, 0.5, 4)};
  const TrackingFigures f =
      measure_tracking(two_trees(), detections_of({trees, {}, {}, trees}), 0.5);
  EXPECT_NEAR(f.idf1, 2.0 * 4 / 12, 1e-12);
  EXPECT_EQ(f.id_switches, 0);
}

}  // namespace
}  // namespace bole
