#include "detect/network/network.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "detect/network/close_look.h"
#include "detect/network/last_look.h"
#include "golden_file.h"

namespace bole {
namespace {

template <class Values>
Values waves(float factor) {
  Values values;
  for (int i = 0; i < static_cast<int>(values.size()); ++i)
    values[i] = std::sin(factor * static_cast<float>(i * i % 101));
  return values;
}

TrunkFeatures::Values some_features() { return waves<TrunkFeatures::Values>(0.37F); }
FootPatch::Values some_foot() { return waves<FootPatch::Values>(0.23F); }

TrunkPatches some_patches() {
  TrunkPatches patches;
  for (int i = 0; i < TrunkPatches::kCells; ++i) {
    patches.trunk[i] = static_cast<std::int8_t>(i * i % 101 - 50);
    patches.around[i] = static_cast<std::int8_t>(i * i % 67 - 33);
  }
  return patches;
}

void expect_golden(const char* name, const Judgement& now, float tolerance = 5e-3F) {
  static_assert(sizeof(Judgement) == 7 * sizeof(float));
  const auto bytes = golden(name, std::as_bytes(std::span(&now, 1)));
  ASSERT_EQ(bytes.size(), sizeof(Judgement));
  float was[7], is[7];
  std::memcpy(was, bytes.data(), sizeof was);
  std::memcpy(is, &now, sizeof is);
  for (int i = 0; i < 7; ++i) EXPECT_NEAR(is[i], was[i], tolerance) << i;
}

// By judge or judge_at_a_glance.
template <class Judge>
Judgement one(const Judge& judge, const TrunkFeatures::Values& features) {
  Judgement judgement;
  judge(std::span(&features, 1), std::span(&judgement, 1));
  return judgement;
}

// The weights as they were trained: a change of them, or of how they are used, shows here.
TEST(Network, JudgesAsTheTrainedWeightsSay) {
  expect_golden("detect/judgement.bin", one(judge, some_features()));
  expect_golden("detect/glance.bin", one(judge_at_a_glance, some_features()));
}

// As the trainer's own library computes it, without whole numbers: its script writes this file.
TEST(Network, JudgesCloselyAsTheTrainerDoes) {
  expect_golden("detect/close_look.bin", judge_closely(some_features(), some_patches()), 0.03F);
}

TEST(Network, LocatesAsTheTrainerDoes) {
  expect_golden("detect/last_look.bin", locate(some_features(), some_foot()), 0.03F);
}

TEST(Network, DoesNotSayWhetherItIsATrunkThatItLocates) {
  EXPECT_EQ(locate(some_features(), some_foot()).logit, 0);
}

TEST(Network, SeesBothPatchesInACloseLook) {
  const Judgement judgement = judge_closely(some_features(), some_patches());
  for (const auto patch : {&TrunkPatches::trunk, &TrunkPatches::around}) {
    TrunkPatches patches = some_patches();
    std::reverse((patches.*patch).begin(), (patches.*patch).end());
    EXPECT_NE(judge_closely(some_features(), patches).logit, judgement.logit);
  }
}

TEST(Network, DoesNotLookAtTheFootAtAGlance) {
  TrunkFeatures::Values features = some_features();
  const Judgement with_foot = one(judge_at_a_glance, features);
  std::fill_n(features.begin() + TrunkFeatures::kGrid, TrunkFeatures::kFoot, 9.0F);
  features.back() = 9;
  const Judgement without = one(judge_at_a_glance, features);
  EXPECT_EQ(std::memcmp(&with_foot, &without, sizeof(Judgement)), 0);
}

TEST(Network, ShiftsAShapeAsItSays) {
  const TrunkShape shape{
      .foot = 200, .left = 100, .right = 120, .left_slope = 0.1F, .right_slope = 0.1F};
  Judgement judgement;
  judgement.centre_shift = 0.1F;
  judgement.log_width = std::log(1.5F);
  judgement.foot_shift = 2;
  const double focal = 1440 / 6.2831853;
  const TrunkShape better = corrected(shape, judgement, focal);
  EXPECT_NEAR(better.foot, 200 + 2 * foot_unit(shape, focal), 1e-3);
  EXPECT_NEAR(better.width(), 30, 1e-3);
  EXPECT_NEAR(better.centre(), 112 + 0.1 * (better.foot - 200), 1e-3);
}

}  // namespace
}  // namespace bole
