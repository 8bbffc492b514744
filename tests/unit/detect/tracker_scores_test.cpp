#include "detect/tracking/tracker.h"

#include <gtest/gtest.h>

#include <vector>

#include "unit/detect/world_tree.h"

namespace bole {
namespace {

// One tree, ahead of a robot that stands, seen with these scores in frames 0.1 s apart.
std::vector<float> tracked_scores(const std::vector<float>& scores,
                                  Tracker::Scores meaning = Tracker::Scores::probabilities) {
  Tracker tracker(meaning);
  std::vector<float> result;
  for (const float score : scores) {
    std::vector<Tree> one{seen({4, 1, 0.4}, {})};
    one[0].score = score;
    tracker.update(one, result.empty() ? 0 : 0.1);
    result.push_back(one[0].score);
  }
  return result;
}

TEST(Tracker, ScoresATreeByItsHistory) {
  const std::vector<float> known = tracked_scores({0.8F, 0.8F, 0.8F, 0.8F, 0.8F, 0.8F, 0.8F, 0.3F});
  EXPECT_GT(known[6], 0.8F);
  EXPECT_GT(known.back(), 0.5F) << "seen badly once";
  EXPECT_LT(known.back(), known[6]);
  const std::vector<float> doubtful =
      tracked_scores({0.1F, 0.1F, 0.1F, 0.1F, 0.1F, 0.1F, 0.1F, 0.6F});
  EXPECT_LT(doubtful[6], 0.2F);
  EXPECT_LT(doubtful.back(), known[6]) << "a rock that once looks like a tree";
}

TEST(Tracker, ListsANewClearTreeAtOnce) { EXPECT_GT(tracked_scores({0.9F})[0], 0.8F); }

TEST(Tracker, NeverGrowsSureOfWhatIsAlwaysDoubtful) {
  // Frames of one thing are alike: forty times 0.6 is not forty witnesses.
  const std::vector<float> scores = tracked_scores(std::vector<float>(40, 0.6F));
  EXPECT_LT(scores.back(), 0.85F);
}

TEST(Tracker, IsLessSureOfWhatIsSeenNowAndThen) {
  const auto score_when_seen_every = [](int frames) {
    Tracker tracker;
    float score = 0;
    for (int frame = 0; frame <= 24; ++frame) {
      std::vector<Tree> trees;
      if (frame % frames == 0) trees = {seen({4, 1, 0.3}, {})};
      tracker.update(trees, frame == 0 ? 0 : 0.1);
      if (!trees.empty()) score = trees[0].score;
    }
    return score;
  };
  EXPECT_LT(score_when_seen_every(4), score_when_seen_every(1) - 0.1F);
}

TEST(Tracker, IsSurerOfWhatStandsStillAlongTheRobotsWay) {
  const auto score_after = [](double speed) {
    Tracker tracker;
    float score = 0;
    for (int frame = 0; frame < 30; ++frame) {
      std::vector<Tree> trees;
      for (const WorldTree& tree :
           {WorldTree{4, 3, 0.3}, {5, -4, 0.3}, {7, 2, 0.3}, {3, -3, 0.3}}) {
        trees.push_back(seen(tree, {0.1 * frame * speed, 0, 0}));
        trees.back().range_sigma = 0.2F * trees.back().range;
        trees.back().score = 0.5F;
      }
      tracker.update(trees, frame == 0 ? 0 : 0.1);
      score = trees[0].score;
    }
    return score;
  };
  EXPECT_GT(score_after(1), score_after(0) + 0.1F);
}

TEST(Tracker, LeavesScoresThatAreNoProbabilitiesAsTheyAre) {
  EXPECT_EQ(tracked_scores({0.9F, 0.2F, 0.7F}, Tracker::Scores::ranks),
            (std::vector<float>{0.9F, 0.2F, 0.7F}));
}

}  // namespace
}  // namespace bole
