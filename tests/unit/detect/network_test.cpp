#include "detect/network.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "golden_file.h"

namespace bole {
namespace {

// The weights as they were trained: a change of them, or of how they are used, shows here.
TEST(Network, JudgesAsTheTrainedWeightsSay) {
  TrunkFeatures::Values features;
  for (int i = 0; i < TrunkFeatures::kCount; ++i)
    features[i] = std::sin(0.37F * static_cast<float>(i * i % 101));
  const Judgement now = judge(features);
  static_assert(sizeof(Judgement) == 7 * sizeof(float));
  const auto bytes = golden("detect/judgement.bin", std::as_bytes(std::span(&now, 1)));
  ASSERT_EQ(bytes.size(), sizeof(Judgement));
  float was[7], is[7];
  std::memcpy(was, bytes.data(), sizeof was);
  std::memcpy(is, &now, sizeof is);
  for (int i = 0; i < 7; ++i) EXPECT_NEAR(is[i], was[i], 5e-3) << i;
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
