#include "detect/trunk_finder.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "painted_panorama.h"

namespace bole {
namespace {

TEST(TrunkFinder, ReadsNoOutlineThatLeadsOutOfTheBands) {
  PaintedPanorama panorama(full_panorama(1440, 0.4, 0.9, 1.0));
  panorama.plant({0.5, 3.0, 0.4, 45});
  TrunkFinder finder(panorama.setup());
  finder.candidates(panorama.view());
  const TrunkShape inside{.foot = 200, .left = 700, .right = 720};
  TrunkShape above = inside, beside = inside, leaning = inside, inverted = inside;
  above.foot = -73;
  beside.left = -900;
  beside.right = -880;
  leaning.left_slope = leaning.right_slope = 40;
  inverted.right = inverted.left - 1;

  TrunkFeatures::Values features;
  EXPECT_TRUE(finder.read(panorama.view(), inside, {}, features));
  for (const TrunkShape& shape : {above, beside, leaning, inverted})
    EXPECT_FALSE(finder.read(panorama.view(), shape, {}, features));
}

// What a patch holds: a dark trunk's core is darker than what is beside it, and brighter where its
// polarity is turned round; in the surroundings it is as narrow as it is in the picture.
TEST(TrunkFinder, ShowsATrunkInItsPatches) {
  PaintedPanorama panorama(full_panorama(1440, 0.4, 0.9, 1.0));
  panorama.plant({0.5, 3.0, 0.4, 45});
  TrunkFinder finder(panorama.setup());
  finder.candidates(panorama.view());
  const auto& geometry = panorama.setup().panorama;
  const auto middle = static_cast<float>(geometry.column_of_bearing(0.5) + 0.5);
  const auto half = static_cast<float>(0.5 * angular_width(0.4, 3.0) * geometry.focal());
  const auto foot = static_cast<float>(geometry.row_of_tangent(ground_tangent(2.8, 1.0)) + 0.5);
  TrunkShape shape{.foot = foot, .left = middle - half, .right = middle + half};
  const auto mean = [](const TrunkPatches::Patch& patch, int first, int last) {
    int sum = 0;
    for (int y = 4; y < 24; ++y)
      for (int x = first; x < last; ++x) sum += patch[y * TrunkPatches::kSide + x];
    return sum / (20 * (last - first));
  };
  const TrunkPatches dark = finder.patches(shape);
  EXPECT_LT(mean(dark.trunk, 13, 19), mean(dark.trunk, 0, 10) - 20);
  EXPECT_LT(mean(dark.trunk, 13, 19), mean(dark.trunk, 22, 32) - 20);
  EXPECT_LT(mean(dark.around, 15, 17), mean(dark.around, 18, 32) - 20);
  shape.dark = false;
  EXPECT_GT(mean(finder.patches(shape).trunk, 13, 19), mean(finder.patches(shape).trunk, 0, 10));
}

// Outlines at the borders, wider than the panorama, higher than its first row.
TEST(TrunkFinder, ShowsWhatThereIsOfAnOutlineThatLeadsOut) {
  PaintedPanorama panorama(full_panorama(1440, 0.4, 0.9, 1.0));
  TrunkFinder finder(panorama.setup());
  finder.candidates(panorama.view());
  for (const TrunkShape& shape : {TrunkShape{.foot = 9, .left = -30, .right = 2},
                                  TrunkShape{.foot = 900, .left = 0, .right = 1440},
                                  TrunkShape{.foot = 100, .left = 1439, .right = 1439.1F}}) {
    const TrunkPatches patches = finder.patches(shape);
    EXPECT_TRUE(std::any_of(patches.around.begin(), patches.around.end(),
                            [](int level) { return level != 0; }));
  }
}

TEST(TrunkFinder, TakesMoreTimeTheFartherItSearches) {
  const Effort near = Effort::for_reach(8), far = Effort::for_reach(40);
  EXPECT_LT(near.candidates, far.candidates);
  EXPECT_LT(near.close_looks, far.close_looks);
  EXPECT_GT(near.worth_a_second_look, far.worth_a_second_look);
  EXPECT_EQ(Effort::for_reach(2).candidates, near.candidates);
  EXPECT_EQ(Effort::for_reach(100).candidates, far.candidates);
}

// However much is in doubt, only so much is looked at closely; and what is clear is not.
TEST(TrunkFinder, LooksCloselyAtWhatIsInDoubt) {
  PaintedPanorama panorama(full_panorama(1440, 0.4, 0.9, 1.0));
  for (int i = 0; i < 24; ++i) panorama.plant({-3.0 + 0.25 * i, 2.5 + 0.2 * i, 0.3, 100 + i});
  TrunkFinder finder(panorama.setup({{1, 40}, {0.1, 1.2}}));
  int close = 0;
  for (const Trunk& trunk : finder.find(panorama.view())) {
    close += trunk.seen_closely;
    EXPECT_TRUE(trunk.logit < 5 || !trunk.seen_closely) << trunk.logit;
  }
  EXPECT_GT(close, 0);
  EXPECT_LE(close, finder.effort().close_looks);
}

}  // namespace
}  // namespace bole
