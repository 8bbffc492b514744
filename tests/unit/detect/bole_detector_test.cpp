#include "detect/bole_detector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "painted_panorama.h"

namespace bole {
namespace {

std::vector<Tree> sure_trees(const PaintedPanorama& panorama, const Search& search = {}) {
  const auto detector = make_bole_detector(panorama.setup(search));
  std::vector<Tree> sure;
  for (const Tree& tree : detector->detect(panorama.view()))
    if (tree.score >= 0.5F) sure.push_back(tree);
  return sure;
}

PanoramaGeometry usual() { return full_panorama(1440, radians(27), 0.9, 1.0); }

std::vector<Tree> sure_trees(const std::vector<PaintedPanorama::Bar>& bars) {
  PaintedPanorama panorama(usual());
  for (const auto& bar : bars) panorama.plant(bar);
  return sure_trees(panorama);
}

// The likeliest one there; null for none. `trees` as detected: the likeliest first.
const Tree* tree_at(std::span<const Tree> trees, double bearing, double tolerance = radians(1)) {
  const auto tree = std::find_if(trees.begin(), trees.end(), [&](const Tree& t) {
    return std::abs(wrap_angle(t.bearing - bearing)) <= tolerance;
  });
  return tree == trees.end() ? nullptr : &*tree;
}

void expect_found(const std::vector<Tree>& trees, const PaintedPanorama::Bar& bar) {
  const Tree* tree = tree_at(trees, bar.bearing);
  ASSERT_NE(tree, nullptr) << "no tree at bearing " << bar.bearing;
  EXPECT_NEAR(tree->range, bar.range, 0.04 * bar.range);
  EXPECT_NEAR(tree->diameter, bar.diameter, 0.04);
  EXPECT_NEAR(std::sin(tree->angular_width / 2), tree->diameter / (2 * tree->range), 1e-3);
  EXPECT_GT(tree->range_sigma, 0);
}

const std::vector<PaintedPanorama::Bar> kBars{
    {0.5, 3.0, 0.4, 45}, {-1.2, 5.0, 0.3, 50}, {2.0, 3.0, 0.35, 60}, {-2.4, 6.5, 0.5, 40}};

TEST(BoleDetector, PlacesTrunks) {
  const auto trees = sure_trees(kBars);
  for (const auto& bar : kBars) expect_found(trees, bar);
  EXPECT_EQ(trees.size(), kBars.size());
}

TEST(BoleDetector, FindsATrunkAcrossTheSeam) {
  PaintedPanorama panorama(usual());
  const PaintedPanorama::Bar bar{-kPi + 0.01, 3.0, 0.4, 45};
  panorama.plant(bar);
  const auto trees = sure_trees(panorama);
  expect_found(trees, bar);
  EXPECT_EQ(trees.size(), 1U);
}

// Where a trunk of that kind is expected.
ExpectedTrunk expected(const PaintedPanorama::Bar& bar) {
  const double foot = bar.range - bar.diameter / 2;
  return {.bearing = static_cast<float>(bar.bearing),
          .base_elevation = static_cast<float>(std::atan(ground_tangent(foot, 1.0))),
          .angular_width = static_cast<float>(angular_width(bar.diameter, bar.range))};
}

float score_at(std::span<const Tree> trees, double bearing) {
  const Tree* tree = tree_at(trees, bearing);
  return tree ? tree->score : 0;
}

TEST(BoleDetector, IsSurerOfTrunksThatItIsToldToExpect) {
  // Bright before bright ground and nearly as bright as the sky: the templates see half of it.
  float alone = 0, told = 0;
  for (int grey = 200; grey <= 250; grey += 10) {
    PaintedPanorama panorama(usual());
    const PaintedPanorama::Bar bar{0.5, 7.0, 0.35, grey};
    panorama.plant(bar);
    const auto detector = make_bole_detector(panorama.setup());
    const ExpectedTrunk there = expected(bar);
    alone += score_at(detector->detect(panorama.view()), bar.bearing);
    told += score_at(detector->detect(panorama.view(), {&there, 1}), bar.bearing);
  }
  EXPECT_GT(told, alone + 0.1F);
}

TEST(BoleDetector, TakesTheWholeOfAHalfLitTrunkThatItIsToldToExpect) {
  PaintedPanorama panorama(usual());
  const PaintedPanorama::Bar whole{0.5, 4.0, 0.4, 85};
  const double width = angular_width(whole.diameter, whole.range);
  panorama.plant(whole);
  panorama.plant({whole.bearing + width / 4, whole.range, whole.diameter / 2, 40});
  const auto detector = make_bole_detector(panorama.setup());
  const auto error_of_width = [&](std::span<const Tree> trees) {
    const Tree* tree = tree_at(trees, whole.bearing, width / 2);
    return tree ? std::abs(tree->angular_width - width) : width;
  };
  const ExpectedTrunk there = expected(whole);
  EXPECT_GT(error_of_width(detector->detect(panorama.view())), 0.3 * width) << "the half, alone";
  EXPECT_LT(error_of_width(detector->detect(panorama.view(), {&there, 1})), 0.2 * width);
}

TEST(BoleDetector, FindsNothingWhereATrunkIsExpectedAndNoneStands) {
  PaintedPanorama panorama(usual());
  const auto detector = make_bole_detector(panorama.setup());
  for (double bearing = -3.1; bearing < 3.1; bearing += 0.1) {
    const ExpectedTrunk nothing = expected({bearing, 4.0, 0.3, 0});
    for (const Tree& tree : detector->detect(panorama.view(), {&nothing, 1}))
      EXPECT_LT(tree.score, 0.5F) << "at " << tree.bearing;
  }
}

TEST(BoleDetector, BearsExpectationsThatLeadOutOfThePanorama) {
  PanoramaGeometry geometry = usual();
  geometry.first_column = 700;
  geometry.width = 300;
  PaintedPanorama panorama(geometry);
  const auto detector = make_bole_detector(panorama.setup());
  std::vector<ExpectedTrunk> wild;
  for (const float bearing : {-3.1416F, -1.0F, 0.08F, 0.09F, 3.1415F})
    for (const float elevation : {-1.57F, -1.0F, 0.0F, 0.4F, 1.57F})
      for (const float width : {0.0F, 0.1F, 3.1F}) wild.push_back({bearing, elevation, width});
  for (const Tree& tree : detector->detect(panorama.view(), wild)) EXPECT_LT(tree.score, 0.5F);
}

TEST(BoleDetector, FindsNothingWhereNothingStands) {
  EXPECT_THAT(sure_trees(PaintedPanorama(usual())), testing::IsEmpty());
}

TEST(BoleDetector, LeavesOutTrunksBeyondTheSearchedRange) {
  PaintedPanorama panorama(usual());
  panorama.plant({0.5, 6.0, 0.4, 45});
  EXPECT_THAT(sure_trees(panorama, {.range = {1, 4}, .diameter = {0.2, 0.8}}), testing::IsEmpty());
}

TEST(BoleDetector, WorksOnPartOfATurnAtAnotherScale) {
  PanoramaGeometry geometry = full_panorama(2200, radians(30), 1.5, 1.6);
  geometry.first_column = 700;
  geometry.width = 800;
  PaintedPanorama panorama(geometry, 1.6);
  const PaintedPanorama::Bar bar{0.2, 4.0, 0.4, 45};
  panorama.plant(bar);
  expect_found(sure_trees(panorama), bar);
}

TEST(BoleDetector, KeepsATrunkOnRisingGroundAndSaysThatItsRangeIsUncertain) {
  const PanoramaGeometry geometry = usual();
  PaintedPanorama panorama(geometry);
  const int horizon = static_cast<int>(geometry.horizon_row());
  // The ground up to ten rows above the horizon, and a trunk that stands up there.
  for (int row = horizon - 10; row <= horizon; ++row)
    for (int x = 0; x < geometry.width; ++x)
      panorama.at(row, x) = panorama.at(2 * horizon - row + 1, x);
  for (int row = 0; row < horizon - 8; ++row)
    for (int x = 700; x < 716; ++x) panorama.at(row, x) = static_cast<std::uint8_t>(40 + x % 5);
  const auto trees = sure_trees(panorama);
  ASSERT_EQ(trees.size(), 1U);
  EXPECT_GE(trees[0].range, 1.0F);
  EXPECT_LE(trees[0].range, 8.0F);
  EXPECT_GT(trees[0].range_sigma, 0.25F * trees[0].range);
}

// A wood all round on ground that rises ahead.
std::vector<PaintedPanorama::Bar> wood(double slope) {
  std::vector<PaintedPanorama::Bar> bars;
  for (int i = 0; i < 20; ++i) {
    const double bearing = -3 + 0.31 * i;
    bars.push_back({bearing, 2.5 + 0.2 * (7 * i % 20), 0.3, 45, slope * std::cos(bearing)});
  }
  return bars;
}

double sum_of_sigmas(const std::vector<Tree>& trees) {
  return std::accumulate(trees.begin(), trees.end(), 0.0,
                         [](double sum, const Tree& tree) { return sum + tree.range_sigma; });
}

TEST(BoleDetector, PlacesTreesOnASlopeAndSaysThatItKnowsLessOfTheirRange) {
  const auto bars = wood(0.15);
  const auto on_slope = sure_trees(bars), level = sure_trees(wood(0));
  ASSERT_EQ(on_slope.size(), bars.size());
  ASSERT_EQ(level.size(), bars.size());
  for (const auto& bar : bars) {
    const Tree* tree = tree_at(on_slope, bar.bearing);
    ASSERT_NE(tree, nullptr) << "no tree at bearing " << bar.bearing;
    EXPECT_NEAR(tree->range, bar.range, 0.2 * bar.range);
  }
  EXPECT_GT(sum_of_sigmas(on_slope), 1.2 * sum_of_sigmas(level));
}

TEST(BoleDetector, KeepsToAKnownFootThatGrassHides) {
  const PanoramaGeometry geometry = usual();
  const PaintedPanorama::Bar bar{0.5, 4.0, 0.4, 45};
  PaintedPanorama grass(geometry), panorama(geometry);
  panorama.plant(bar);
  const ExpectedTrunk there = expected(bar);
  const int foot = static_cast<int>(geometry.row_of_tangent(std::tan(there.base_elevation)));
  // Half of it shows between the blades.
  for (int row = foot - 20; row <= foot; ++row) {
    for (int x = 0; x < geometry.width; ++x) {
      const int both = panorama.at(row, x) + grass.at(row, x);
      panorama.at(row, x) = static_cast<std::uint8_t>(both / 2);
    }
  }
  const auto detector = make_bole_detector(panorama.setup());
  const auto error_of_range = [&](std::span<const Tree> trees) {
    const Tree* tree = tree_at(trees, bar.bearing);
    return tree ? std::abs(tree->range - bar.range) : bar.range;
  };
  const double alone = error_of_range(detector->detect(panorama.view()));
  const double told = error_of_range(detector->detect(panorama.view(), {&there, 1}));
  EXPECT_LT(told, 0.5 * alone);
}

TEST(BoleDetector, FindsTrunksThroughFog) {
  PaintedPanorama panorama(usual());
  for (const auto& bar : kBars) panorama.plant(bar);
  panorama.draw_veil(0.15, 190);
  const auto trees = sure_trees(panorama);
  for (const auto& bar : kBars) expect_found(trees, bar);
}

TEST(BoleDetector, SaysTheSameOfTheSameFrame) {
  PaintedPanorama panorama(usual());
  panorama.plant({0.5, 3.0, 0.4, 45});
  const auto detector = make_bole_detector(panorama.setup());
  const auto first = detector->detect(panorama.view());
  ASSERT_FALSE(first.empty());
  const Tree tree = first[0];
  const auto second = detector->detect(panorama.view());
  EXPECT_EQ(tree.range, second[0].range);
  EXPECT_EQ(tree.score, second[0].score);
}

}  // namespace
}  // namespace bole
