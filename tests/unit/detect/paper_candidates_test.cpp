#include "detect/paper/paper_candidates.h"

#include <gmock/gmock.h>

namespace bole {
namespace {

using testing::ElementsAre;

std::vector<int> minima_of(const std::vector<float>& scores, bool wraps) {
  std::vector<PaperCandidate> candidates;
  append_minima(scores, -4, wraps, 7, candidates);
  std::vector<int> columns;
  for (const PaperCandidate& c : candidates) {
    EXPECT_EQ(c.index, 7);
    EXPECT_EQ(c.score, scores[c.column]);
    columns.push_back(c.column);
  }
  return columns;
}

TEST(PaperMinima, AreThoseBelowTheThreshold) {
  EXPECT_THAT(minima_of({0, -3.9F, 0, -4, 0, -4.1F, 0}, true), ElementsAre(5));
}

TEST(PaperMinima, OfAPlateauAreItsFirstColumn) {
  EXPECT_THAT(minima_of({0, -5, -6, -6, -6, -5, 0}, true), ElementsAre(2));
}

TEST(PaperMinima, AShelfOnASlopeIsNone) {
  EXPECT_THAT(minima_of({0, -5, -6, -6, -7, 0}, true), ElementsAre(4));
  EXPECT_THAT(minima_of({0, -7, -6, -6, -5, 0}, true), ElementsAre(1));
}

TEST(PaperMinima, NeedNoThresholdCrossingBetweenThem) {
  EXPECT_THAT(minima_of({-5, -9, -6, -8, -7, -4.5F}, true), ElementsAre(1, 3));
}

TEST(PaperMinima, GoRoundTheSeamOnlyWhereThePanoramaDoes) {
  EXPECT_THAT(minima_of({-6, -5, 0, 0, -5, -7}, true), ElementsAre(5));
  EXPECT_THAT(minima_of({-6, -5, 0, 0, -5, -7}, false), ElementsAre(0, 5));
  EXPECT_THAT(minima_of({-7, -5, 0, 0, -5, -7}, true), ElementsAre(5));
}

TEST(PaperMinima, OfEqualScoresThereAreNone) {
  EXPECT_THAT(minima_of(std::vector<float>(16, -6), true), ElementsAre());
}

// Two depths (rows 200 and 100), a wide and a narrow bar at each.
std::vector<PaperTemplate> two_depths() {
  std::vector<PaperTemplate> templates(4);
  for (int k = 0; k < 4; ++k) {
    templates[k].foot_row = k < 2 ? 200 : 100;
    templates[k].width_px = k % 2 == 0 ? 40 : 10;
  }
  return templates;
}

std::vector<int> kept_of(std::vector<PaperCandidate> candidates, int width = 0) {
  suppress(two_depths(), width, candidates);
  std::vector<int> columns;
  for (const PaperCandidate& c : candidates) columns.push_back(c.column);
  return columns;
}

TEST(PaperSuppression, KeepsTheBestWhereRectanglesHoldEachOthersCentre) {
  EXPECT_THAT(kept_of({{100, 0, -5}, {110, 0, -9}, {119, 1, -7}}), ElementsAre(110));
}

TEST(PaperSuppression, LeavesNeighboursAloneBestFirst) {
  EXPECT_THAT(kept_of({{100, 0, -5}, {120, 0, -9}, {140, 1, -7}}), ElementsAre(120, 140, 100));
}

TEST(PaperSuppression, GoesDownTheColumnOverAllDepths) {
  EXPECT_THAT(kept_of({{100, 0, -5}, {101, 2, -6}, {300, 2, -5}, {301, 0, -8}}),
              ElementsAre(301, 101));
}

// The middle one of three falls to the first along its row, so it cannot suppress the third, of
// another depth.
TEST(PaperSuppression, WhatFellAlongTheRowSuppressesNothingDownTheColumn) {
  EXPECT_THAT(kept_of({{100, 0, -9}, {115, 0, -8}, {130, 2, -7}}), ElementsAre(100, 130));
}

TEST(PaperSuppression, GoesRoundTheSeamOnlyWhereThePanoramaDoes) {
  EXPECT_THAT(kept_of({{2, 0, -5}, {1435, 0, -6}}, 1440), ElementsAre(1435));
  EXPECT_THAT(kept_of({{2, 0, -5}, {1435, 0, -6}}), ElementsAre(1435, 2));
}

}  // namespace
}  // namespace bole
