#include "detect/range_posterior.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/ground.h"

namespace bole {
namespace {

constexpr double kHeight = 1.2;
const Search kNear{{1, 8}, {0.2, 0.8}};
const Search kFar{{1, 40}, {0.1, 1.2}};

TrunkSight upright(double range, double diameter) {
  return {.down = kHeight / (range - diameter / 2),
          .down_sigma = 0.003,
          .angular_width = angular_width(diameter, range)};
}

TEST(RangePosterior, TakesTheRangeFromTheFootOnEvenGround) {
  const RangePosterior posterior(kHeight, kNear);
  for (const double range : {1.5, 3.0, 5.0, 7.0}) {
    const RangeEstimate estimate = posterior.estimate(upright(range, 0.35));
    EXPECT_NEAR(estimate.range, range, 0.02 * range);
    EXPECT_LT(estimate.sigma, 0.1 * range);
    EXPECT_GT(estimate.searched, 0.9);
  }
}

TEST(RangePosterior, TakesAThinStemAtTheHorizonForADistantTree) {
  const RangePosterior near(kHeight, kNear), far(kHeight, kFar);
  const TrunkSight stem{.down = 0.01, .down_sigma = 0.004, .angular_width = 0.02};
  EXPECT_LT(near.estimate(stem).searched, 0.15);
  EXPECT_GT(far.estimate(stem).searched, 0.5);
}

TEST(RangePosterior, GivesATreeOnRisingGroundTheRangeOfItsWidthAndALargeSigma) {
  const RangePosterior posterior(kHeight, kFar);
  const TrunkSight rising{.down = -0.1, .down_sigma = 0.004, .angular_width = 0.04};
  const RangeEstimate estimate = posterior.estimate(rising);
  EXPECT_GT(estimate.range, 0.15 / 0.04);
  EXPECT_LT(estimate.range, 0.8 / 0.04);
  EXPECT_GT(estimate.sigma, 0.25 * estimate.range);
  EXPECT_GT(estimate.searched, 0.9);
}

TEST(RangePosterior, KeepsARisingTreeWithinTheSearchedRange) {
  const Search search{{1, 8}, {0.1, 1.2}};
  const RangeEstimate estimate =
      RangePosterior(kHeight, search).estimate({-0.05, 0.004, angular_width(0.3, 9)});
  EXPECT_GT(estimate.searched, 0);
  EXPECT_LE(estimate.range, 1.1 * search.range.high);
}

TEST(RangePosterior, DoubtsAFootWhereNoTreeOfThatWidthCanStand) {
  // A foot at 2 m, and a width that would make the trunk 6 cm thick.
  const RangePosterior posterior(kHeight, kNear);
  const TrunkSight sight = upright(2, 0.06);
  EXPECT_LT(posterior.estimate(sight).searched, 0.3);
}

TEST(RangePosterior, KnowsOfAFootOutOfSightOnlyThatTheTreeIsNear) {
  const RangePosterior posterior(kHeight, kNear);
  // The sight ends where level ground is 2.4 m away; the trunk is as wide as 0.35 m at 1.3 m.
  TrunkSight sight = upright(1.3, 0.35);
  sight.down = 0.5;
  const double believed = posterior.estimate(sight).range;
  sight.cut = true;
  const RangeEstimate estimate = posterior.estimate(sight);
  EXPECT_LT(estimate.range, believed - 0.3);
  EXPECT_NEAR(estimate.range, 1.3, estimate.sigma);
  EXPECT_GT(estimate.sigma, 0.1 * estimate.range);
  EXPECT_GT(estimate.searched, 0.7);
}

TEST(RangePosterior, IsLessSureOfARangeWhoseFootIsLessSure) {
  const RangePosterior posterior(kHeight, kNear);
  TrunkSight sight = upright(4, 0.4);
  const double sure = posterior.estimate(sight).sigma;
  sight.down_sigma = 0.03;
  EXPECT_GT(posterior.estimate(sight).sigma, 1.3 * sure);
}

TEST(RangePosterior, FindsAFootLikelierWhereATreeOfItsWidthIs) {
  const RangePosterior posterior(kHeight, kFar);
  const TrunkSight tree = upright(5, 0.35);
  TrunkSight raised = tree;
  raised.down = -0.2;
  EXPECT_GT(posterior.log_likelihood(tree), posterior.log_likelihood(raised) + 1);
}

}  // namespace
}  // namespace bole
