#include "detect/tracking/tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "unit/detect/world_tree.h"

namespace bole {
namespace {

TEST(Tracker, IsNotCarriedAwayByFalseAlarms) {
  constexpr unsigned kSeeds = 10;
  double turns = 0, shifts = 0;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    Tracker tracker;
    double worst_turn = 0, worst_shift = 0;
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> bearing(-3.1F, 3.1F), range(2, 8);
    for (int frame = 0; frame < 200; ++frame) {
      std::vector<Tree> noise(4, seen({3, 0, 0.3}, {}));
      for (Tree& tree : noise) {
        tree.bearing = bearing(random);
        tree.range = range(random);
      }
      tracker.update(noise, 0.1);
      const EgoMotion motion = tracker.last_motion();
      worst_turn = std::max(worst_turn, std::abs(motion.turn));
      worst_shift = std::max(worst_shift, std::hypot(motion.forward, motion.left));
    }
    EXPECT_LT(worst_turn, 0.35);
    EXPECT_LT(worst_shift, 0.8);
    turns += worst_turn;
    shifts += worst_shift;
    std::vector<Tree> none;
    for (int frame = 0; frame < 20; ++frame) tracker.update(none, 0.1);
    EXPECT_LT(std::abs(tracker.last_motion().turn), 0.01) << "nothing seen: taken to stand still";
  }
  EXPECT_LT(turns / kSeeds, 0.25);
  EXPECT_LT(shifts / kSeeds, 0.5);
}

TEST(Tracker, PublishesEachTreeAtOnceAndNoneThatIsNotSeen) {
  Tracker tracker;
  std::vector<Tree> one{seen({3, 1, 0.4}, {})};
  tracker.update(one, 0);
  EXPECT_EQ(one[0].id, 0);
  EXPECT_FLOAT_EQ(one[0].range, seen({3, 1, 0.4}, {}).range);
  std::vector<Tree> none;
  tracker.update(none, 0.1);
  EXPECT_TRUE(none.empty());
  tracker.update(one, 0.1);
  EXPECT_EQ(one[0].id, 0) << "a tree hidden for a frame keeps its id";
}

TEST(Tracker, TakesTheLitHalfOfATrunkForTheTree) {
  Tracker tracker;
  const Tree whole = seen({4, 0, 0.5}, {});
  Tree half = whole;
  half.bearing += whole.angular_width / 4;
  half.angular_width = whole.angular_width / 2;
  half.diameter = whole.diameter / 2;
  half.range += 0.9F;
  std::set<int> ids;
  for (int frame = 0; frame < 20; ++frame) {
    std::vector<Tree> one{frame % 3 == 2 ? half : whole};
    tracker.update(one, frame == 0 ? 0 : 0.1);
    ids.insert(one[0].id);
    EXPECT_NEAR(one[0].diameter, whole.diameter, 0.1);
  }
  EXPECT_EQ(ids.size(), 1U);
}

// The ids of a tree that shows its half first, and then the whole `farther` away.
std::set<int> ids_of_half_then_whole(double farther, double* diameter = nullptr) {
  Tracker tracker;
  const Tree whole = seen({4 + farther, 0, 0.5}, {});
  Tree half = seen({4, 0, 0.2}, {});
  half.bearing += whole.angular_width / 4;
  std::set<int> ids;
  for (int frame = 0; frame < 12; ++frame) {
    std::vector<Tree> one{frame < 10 ? half : whole};
    tracker.update(one, frame == 0 ? 0 : 0.1);
    ids.insert(one[0].id);
    if (diameter != nullptr) *diameter = one[0].diameter;
  }
  return ids;
}

TEST(Tracker, KeepsTheIdOfATreeWhoseLitHalfWasSeenFirstAndWidensIt) {
  double diameter = 0;
  EXPECT_EQ(ids_of_half_then_whole(0.2, &diameter).size(), 1U);
  EXPECT_NEAR(diameter, 0.5, 0.08);
}

TEST(Tracker, TakesNoTreeForTheWholeOfOneThatStandsNearer) {
  EXPECT_EQ(ids_of_half_then_whole(1.2).size(), 2U);
}

TEST(Tracker, GivesAProbableTreesIdToTheMoreProbableOfTwoSightings) {
  // The tree has moved by as much to one side as what is hardly a tree stands on the other.
  Tracker tracker;
  const Tree tree = seen({6, 0, 0.3}, {});
  for (int frame = 0; frame < 10; ++frame) {
    std::vector<Tree> one{tree};
    tracker.update(one, frame == 0 ? 0 : 0.1);
  }
  Tree aside = tree, hardly = tree;
  aside.bearing += 0.3F * tree.angular_width;
  hardly.bearing -= 0.25F * tree.angular_width;
  hardly.score = 0.06F;
  std::vector<Tree> both{hardly, aside};
  tracker.update(both, 0.1);
  EXPECT_EQ(both[1].id, 0);
  EXPECT_NE(both[0].id, 0);
}

TEST(Tracker, KeepsTheIdOfATreeWhoseRangeJumps) {
  // Grass hides the foot, and another one is found; middle and width still agree.
  Tree tree = seen({6, 2, 0.4}, {});
  tree.range_sigma = 0.8F;
  Tree farther = tree;
  farther.range += 2;
  Tree narrower = farther;
  narrower.angular_width *= 0.6F;
  for (const auto& [next, same] : {std::pair(farther, true), std::pair(narrower, false)}) {
    Tracker tracker;
    std::vector<Tree> one{tree};
    tracker.update(one, 0);
    one[0] = next;
    tracker.update(one, 0.1);
    EXPECT_EQ(one[0].id == 0, same);
  }
}

TEST(Tracker, ImprobableTreesTellLittleOfTheRobotsMotion) {
  // Four trees ahead, and eight stems far behind that are taken for trees at 8 m: they go along.
  Tracker tracker;
  for (int frame = 0; frame < 40; ++frame) {
    std::vector<Tree> trees;
    for (const double y : {-4.0, -2.0, 2.0, 4.0}) {
      trees.push_back(seen({12, y, 0.3}, {0.1 * frame + 2, 0, 0}));
    }
    for (int k = 0; k < 8; ++k) {
      Tree stem = seen({8 * std::cos(0.5 * k + 1), 8 * std::sin(0.5 * k + 1), 0.3}, {});
      stem.score = 0.06F;
      trees.push_back(stem);
    }
    tracker.update(trees, frame == 0 ? 0 : 0.1);
  }
  EXPECT_NEAR(tracker.last_motion().forward, 0.1, 0.02);
}

TEST(Tracker, NeverGivesTheIdOfAHiddenTreeToItsNeighbourBehind) {
  Tracker tracker;
  std::vector<Tree> near{seen({4, 0, 0.3}, {})};
  near[0].range_sigma = 1.0F;
  tracker.update(near, 0);
  std::vector<Tree> behind{seen({5.3, 0, 0.3}, {})};
  behind[0].range_sigma = 1.0F;
  tracker.update(behind, 0.1);
  EXPECT_NE(behind[0].id, near[0].id);
}

// A tree that is seen, with this score, in so many frames of a straight drive at 1 m/s, 10 Hz,
// among others that tell of the motion.
Tracker tracker_of_a_drive(float score, int frames) {
  Tracker tracker;
  for (int frame = 0; frame < frames; ++frame) {
    std::vector<Tree> trees;
    for (const double y : {-4.0, -2.0, 2.0, 4.0}) {
      trees.push_back(seen({9, y, 0.3}, {0.1 * frame, 0, 0}));
      trees.back().base_elevation = -std::atan(1.0F / (trees.back().range - 0.15F));
      trees.back().score = score;
    }
    tracker.update(trees, frame == 0 ? 0 : 0.1);
  }
  return tracker;
}

TEST(Tracker, ExpectsATreeWhereTheMotionBringsIt) {
  Tracker tracker = tracker_of_a_drive(0.9F, 30);
  const Tree next = seen({9, -4, 0.3}, {3.1, 0, 0});  // 0.2 s after the last frame
  const std::span<const ExpectedTrunk> expected = tracker.expected(0.2);
  ASSERT_EQ(expected.size(), 4U);
  EXPECT_NEAR(expected[0].bearing, next.bearing, 0.01);
  EXPECT_NEAR(expected[0].angular_width, next.angular_width, 0.003);
  EXPECT_NEAR(std::tan(expected[0].base_elevation), -1 / (next.range - 0.15), 0.005);
}

TEST(Tracker, ExpectsNoTreeThatIsNewDoubtfulOrLongUnseen) {
  EXPECT_TRUE(tracker_of_a_drive(0.9F, 2).expected(0.1).empty());
  EXPECT_TRUE(tracker_of_a_drive(0.05F, 30).expected(0.1).empty());
  Tracker tracker = tracker_of_a_drive(0.9F, 30);
  std::vector<Tree> none;
  for (int frame = 0; frame < 5; ++frame) tracker.update(none, 0.1);
  EXPECT_EQ(tracker.expected(0.1).size(), 4U);
  EXPECT_TRUE(tracker.expected(5.0).empty()) << "a gap: nothing says where the robot is";
  for (int frame = 0; frame < 10; ++frame) tracker.update(none, 0.1);
  EXPECT_TRUE(tracker.expected(0.1).empty());
}

TEST(Tracker, GivesNoIdOnThatWasDoubtfulForLong) {
  // What is hardly a tree is seen on and on, here and there; then a tree stands where it is.
  Tracker tracker;
  std::vector<Tree> one{seen({5, 1, 0.3}, {})};
  tracker.update(one, 0);
  const std::int32_t first = one[0].id;
  const auto doubt = [&](int frames) {
    for (int frame = 0; frame < frames; ++frame) {
      one[0] = seen({5, 1, 0.3}, {});
      one[0].score = 0.06F;
      tracker.update(one, 0.1);
    }
    return one[0].id;
  };
  EXPECT_EQ(doubt(40), first);
  EXPECT_NE(doubt(40), first);
}

TEST(Tracker, ForgetsAfterAJumpOfTimeAndNeverReusesAnId) {
  Tracker tracker;
  std::vector<Tree> one{seen({3, 1, 0.4}, {})};
  tracker.update(one, 0.1);
  tracker.update(one, -5.0);
  EXPECT_EQ(one[0].id, 1);
}

TEST(Tracker, BringsTracksToTheScaleOfTheRangesSeen) {
  // For two seconds all seems nearer than it is, as on a hump; then for six as it is.
  Tracker tracker;
  double ratio = 0;
  for (int frame = 0; frame < 80; ++frame) {
    std::vector<Tree> trees;
    for (const double y : {-6.0, -4.0, -2.0, 2.0, 4.0, 6.0}) {
      trees.push_back(seen({12, y, 0.3}, {0.1 * frame, 0, 0}));
      if (frame < 20) trees.back().range *= 0.85F;
      trees.back().range_sigma = 0.1F * trees.back().range;
    }
    const std::vector<Tree> shown = trees;
    tracker.update(trees, frame == 0 ? 0 : 0.1);
    ratio = 0;
    for (std::size_t i = 0; i < trees.size(); ++i)
      ratio += trees[i].range / shown[i].range / static_cast<float>(trees.size());
  }
  EXPECT_NEAR(ratio, 1, 0.04);
}

TEST(Tracker, KeepsIdsAndMotionOverTwoFramesOfOneInstant) {
  Tracker tracker = tracker_of_a_drive(0.9F, 30);
  std::vector<Tree> same{seen({9, -4, 0.3}, {2.9, 0, 0})};
  const double forward = tracker.last_motion().forward;
  tracker.update(same, 0);
  const std::int32_t id = same[0].id;
  EXPECT_EQ(tracker.last_motion().forward, forward);
  std::vector<Tree> next{seen({9, -4, 0.3}, {3.0, 0, 0})};
  tracker.update(next, 0.1);
  EXPECT_EQ(next[0].id, id);
  EXPECT_LT(id, 4) << "an id of the drive";
  EXPECT_NEAR(tracker.last_motion().forward, 0.1, 0.02);
}

}  // namespace
}  // namespace bole
