#include "detect/trunk_finder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>

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

// A faint bar where a searched tree ends goes before a clear one that ends at the horizon.
TEST(TrunkFinder, RanksCandidatesHigherThatEndWhereSearchedTreesDo) {
  PaintedPanorama panorama(full_panorama(1440, 0.4, 0.9, 1.0));
  const PaintedPanorama::Bar tree{1.0, 4.0, 0.4, 106}, stem{-1.0, 40.0, 4.0, 30};
  panorama.plant(tree);
  panorama.plant(stem);
  TrunkFinder finder(panorama.setup());
  const auto candidates = finder.candidates(panorama.view());
  const auto place = [&](const PaintedPanorama::Bar& bar) {
    const double middle = panorama.setup().panorama.column_of_bearing(bar.bearing) + 0.5;
    return std::ranges::find_if(candidates, [&](const Candidate& c) {
      return c.dark && std::abs(c.left + c.width / 2 - middle) < 3;
    });
  };
  ASSERT_NE(place(stem), candidates.end());
  EXPECT_LT(place(tree), place(stem));
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
  // Its foot lies a width above the lower end.
  const auto core = [&](int y) { return dark.trunk[y * TrunkPatches::kSide + 15]; };
  const float rows = foot + 2 * half;  // that the patch shows
  const int at_foot = static_cast<int>(foot / rows * TrunkPatches::kSide);
  EXPECT_LT(core(at_foot - 3), -20);
  EXPECT_GT(core(at_foot + 3), -20);
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
  EXPECT_LT(near.last_looks, far.last_looks);
  EXPECT_GT(near.worth_a_second_look, far.worth_a_second_look);
  EXPECT_EQ(Effort::for_reach(2).candidates, near.candidates);
  EXPECT_EQ(Effort::for_reach(100).candidates, far.candidates);
}

// Trunks as grey as the ground under a camera's noise, of which most are in doubt: near by only so
// many are looked at closely, and more where the search goes far.
TEST(TrunkFinder, LooksCloselyAtWhatIsInDoubt) {
  PaintedPanorama panorama(full_panorama(1440, 0.4, 0.9, 1.0));
  for (int i = 0; i < 24; ++i) panorama.plant({-3.0 + 0.25 * i, 2.0 + 0.2 * i, 0.3, 110});
  simulate::Random random(1);
  for (std::uint8_t& pixel : panorama.pixels()) {
    const float noisy = static_cast<float>(pixel) + 30 * random.normal();
    pixel = static_cast<std::uint8_t>(std::clamp(noisy, 0.0F, 255.0F));
  }
  struct Looks {
    int close = 0, left_in_doubt = 0;
  };
  const auto looks = [&](const Search& search) {
    TrunkFinder finder(panorama.setup(search));
    Looks sum;
    for (const Trunk& trunk : finder.find(panorama.view())) {
      sum.close += trunk.seen_closely;
      sum.left_in_doubt += !trunk.seen_closely && std::abs(trunk.logit) < 1.5F;
    }
    return sum;
  };
  const Looks near = looks({}), far = looks({{1, 40}, {0.1, 1.2}});
  EXPECT_GT(near.close, 0);
  EXPECT_LE(near.close, Effort::for_reach(8).close_looks);
  EXPECT_GT(near.left_in_doubt, 0);
  EXPECT_GT(far.close, Effort::for_reach(8).close_looks);
  EXPECT_LT(far.left_in_doubt, near.left_in_doubt);
}

// The same trunk, on either side of the seam.
TEST(TrunkFinder, ShowsTheSamePatchesAFullTurnAway) {
  PaintedPanorama panorama(full_panorama(1440, 0.4, 0.9, 1.0));
  panorama.plant({3.1, 1.2, 0.5, 60});
  for (const Search& search : {Search{}, Search{{2, 8}, {0.2, 0.8}}}) {
    TrunkFinder finder(panorama.setup(search));
    finder.candidates(panorama.view());
    const TrunkShape before{.foot = 220, .left = -50, .right = 50};
    const TrunkShape after{.foot = 220, .left = 1390, .right = 1490};
    EXPECT_EQ(finder.patches(before).trunk, finder.patches(after).trunk);
    EXPECT_EQ(finder.patches(before).around, finder.patches(after).around);
  }
}

// Cells of a patch are never wider than sums of 16 bits allow, however large the panorama: white
// stays brighter than grey.
TEST(TrunkFinder, ShowsWhatIsBrightAsBrightInLargePanoramas) {
  PaintedPanorama panorama(full_panorama(5760, 0.4, 0.9, 1.0));
  for (int row = 0; row < 60; ++row)
    for (int x = 0; x < 5760; ++x) panorama.at(row, x) = 255;
  TrunkFinder finder(panorama.setup());
  finder.candidates(panorama.view());
  const TrunkPatches patches =
      finder.patches({.foot = 900, .left = 2000, .right = 2900, .dark = true});
  for (const auto& patch : {patches.trunk, patches.around}) {
    const auto top = std::span(patch).first(TrunkPatches::kSide);
    EXPECT_GT(*std::min_element(top.begin(), top.end()), 10);
  }
}

}  // namespace
}  // namespace bole
