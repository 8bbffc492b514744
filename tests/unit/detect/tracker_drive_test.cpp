#include "detect/tracking/tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "geometry/angles.h"
#include "unit/detect/world_tree.h"

namespace bole {
namespace {

// A wood of trees at least 1.2 m apart, and a robot that winds through it at 1 m/s, 10 Hz.
class Wood {
 public:
  explicit Wood(unsigned seed) : random_(seed) {
    std::uniform_real_distribution<double> place(-12, 42), across(-14, 14), diameter(0.2, 0.8);
    while (trees_.size() < 120) {
      const WorldTree next{place(random_), across(random_), diameter(random_)};
      const bool apart = std::ranges::all_of(trees_, [&](const WorldTree& other) {
        return std::hypot(other.x - next.x, other.y - next.y) > 1.2;
      });
      if (apart) trees_.push_back(next);
    }
  }

  static Pose pose(int frame) {
    const double t = 0.1 * frame;
    return {t, 0.8 * std::sin(0.5 * t), std::atan2(0.4 * std::cos(0.5 * t), 1.0)};
  }

  // One frame as a good detector sees it: noise, one tree in ten missed, in random order.
  std::pair<std::vector<Tree>, std::vector<int>> frame(int index) {
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<double> chance(0, 1);
    std::vector<int> which;
    for (int k = 0; k < static_cast<int>(trees_.size()); ++k) {
      if (seen(trees_[k], pose(index)).range < 8 && chance(random_) > 0.1) which.push_back(k);
    }
    std::ranges::shuffle(which, random_);
    std::vector<Tree> found;
    for (const int k : which) {
      Tree tree = seen(trees_[k], pose(index));
      tree.bearing += normal(random_) * tree.bearing_sigma;
      tree.range += normal(random_) * tree.range_sigma;
      tree.diameter += normal(random_) * tree.diameter_sigma;
      found.push_back(tree);
    }
    return {found, which};
  }

  const WorldTree& tree(int k) const { return trees_[k]; }

 private:
  std::mt19937 random_;
  std::vector<WorldTree> trees_;
};

TEST(Tracker, KeepsOneIdForEachTreeOfAWindingDrive) {
  Wood wood(7);
  Tracker tracker;
  std::map<int, std::set<int>> ids_of_tree, trees_of_id;
  for (int frame = 0; frame < 300; ++frame) {
    auto [found, which] = wood.frame(frame);
    tracker.update(found, 0.1);
    for (std::size_t i = 0; i < found.size(); ++i) {
      ids_of_tree[which[i]].insert(found[i].id);
      trees_of_id[found[i].id].insert(which[i]);
    }
  }
  for (const auto& [id, trees] : trees_of_id) EXPECT_EQ(trees.size(), 1U) << "id " << id;
  const auto torn =
      std::ranges::count_if(ids_of_tree, [](const auto& e) { return e.second.size() > 1; });
  EXPECT_LE(torn, 2) << "of " << ids_of_tree.size() << " trees";
}

TEST(Tracker, KeepsIdsWhileTheRobotPitchesAndFewTreesAreFound) {
  Wood wood(11);
  Tracker tracker;
  std::map<int, std::set<int>> trees_of_id;
  std::map<int, std::map<int, int>> sightings;  // of a tree, by id
  int total = 0;
  for (int frame = 0; frame < 300; ++frame) {
    auto [found, which] = wood.frame(frame);
    const double pitch = radians(0.7) * std::sin(0.9 * frame);  // of a camera 1 m up
    for (Tree& tree : found) {
      const double tangent = 1 / tree.range - pitch * std::cos(tree.bearing);
      tree.range = static_cast<float>(1 / std::max(tangent, 0.05));
    }
    found.resize(found.size() / 2);
    tracker.update(found, 0.1);
    for (std::size_t i = 0; i < found.size(); ++i) {
      trees_of_id[found[i].id].insert(which[i]);
      ++sightings[which[i]][found[i].id];
      ++total;
    }
  }
  int main_ids = 0;
  for (const auto& [tree, ids] : sightings) {
    main_ids += std::ranges::max_element(ids, {}, [](const auto& e) { return e.second; })->second;
  }
  EXPECT_GT(main_ids, 0.9 * total);
}

TEST(Tracker, EstimatesTheRobotsMotionFromTheTrees) {
  Wood wood(3);
  Tracker tracker;
  double worst_shift = 0, worst_turn = 0;
  for (int frame = 0; frame < 100; ++frame) {
    auto [found, which] = wood.frame(frame);
    tracker.update(found, 0.1);
    if (frame < 10) continue;
    const Pose from = Wood::pose(frame - 1), to = Wood::pose(frame);
    const GroundPoint shift = moved({to.x, to.y}, {from.x, from.y, from.heading});
    const EgoMotion motion = tracker.last_motion();
    worst_shift =
        std::max(worst_shift, std::hypot(motion.forward - shift.x, motion.left - shift.y));
    worst_turn =
        std::max(worst_turn, std::abs(wrap_angle(motion.turn - (to.heading - from.heading))));
  }
  EXPECT_LT(worst_shift, 0.08);
  EXPECT_LT(worst_turn, 0.01);
}

TEST(Tracker, SharpensRangeAndDiameterOverTime) {
  Wood wood(5);
  Tracker tracker;
  struct Errors {
    double range = 0, diameter = 0;
    void add(const Tree& tree, const Tree& truth) {
      range += std::abs(tree.range - truth.range);
      diameter += std::abs(tree.diameter - truth.diameter);
    }
  } single, refined;
  int count = 0;
  for (int frame = 0; frame < 100; ++frame) {
    auto [found, which] = wood.frame(frame);
    const std::vector<Tree> alone = found;
    tracker.update(found, 0.1);
    if (frame < 30) continue;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Tree truth = seen(wood.tree(which[i]), Wood::pose(frame));
      single.add(alone[i], truth);
      refined.add(found[i], truth);
      ++count;
    }
  }
  ASSERT_GT(count, 500);
  EXPECT_LT(refined.range, 0.75 * single.range);
  EXPECT_LT(refined.diameter, 0.75 * single.diameter);
}

}  // namespace
}  // namespace bole
