#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "detect/network/dense_layer.h"
#include "detect/network/patch_kernels.h"
#include "each_target.h"
#include "simulate/noise.h"

namespace bole {
namespace {

class NetworkKernels : public EachTarget {};

INSTANTIATE_TEST_SUITE_P(All, NetworkKernels, each_target(), target_name);

TEST_P(NetworkKernels, JudgeAsThePlainLoops) {
  simulate::Random random(4);
  constexpr int kLooks = kLooksAtOnce + 2;
  std::vector<std::int16_t> in(206 * kLooks), weights(206 * 96);
  for (auto& value : in) value = static_cast<std::int16_t>(random.uniform(-8192, 8192));
  for (auto& weight : weights) weight = static_cast<std::int16_t>(1000 * random.normal());
  std::vector<float> bias(96), fast(96 * kLooks), plain(96 * kLooks), second(96 * 48);
  for (auto* values : {&bias, &second})
    for (float& value : *values) value = random.normal();
  for (const int units : {16, 32, 48, 96}) {
    hidden_layer(in.data(), kLooks, 103, weights.data(), bias.data(), units, fast.data());
    hidden_layer_plain(in.data(), kLooks, 103, weights.data(), bias.data(), units, plain.data());
    EXPECT_EQ(fast, plain);
  }
  for (const int units : {8, 48}) {
    std::vector<float> out(units, 0.5F), out_plain = out;
    add_products(plain.data(), 96, second.data(), units, out.data());
    add_products_plain(plain.data(), 96, second.data(), units, out_plain.data());
    EXPECT_EQ(out, out_plain);
  }
}

// A picture of 16 channels, convolved by the book: 3 x 3 cells about every other one.
TEST_P(NetworkKernels, ConvolveAPicture) {
  constexpr int kSide = 14, kFrom = 16, kRow = (kSide + 1) * kFrom;
  simulate::Random random(9);
  std::vector<std::int16_t> cells(kRow * (kSide + 1)), weights(9 * kFrom * 48);
  for (auto* values : {&cells, &weights})
    for (std::int16_t& value : *values) value = static_cast<std::int16_t>(900 * random.normal());
  std::vector<float> bias(48);
  for (float& value : bias) value = random.normal();
  const Windows windows{.first = cells.data(),
                        .rows = kSide / 2,
                        .across = kSide / 2,
                        .step = 2 * kFrom,
                        .row_step = 2 * kRow,
                        .runs = 3,
                        .run_pairs = 3 * kFrom / 2,
                        .run_step = kRow};
  for (const int units : {16, 32, 48}) {
    std::vector<float> fast(windows.rows * windows.across * units), plain(fast.size());
    convolve(windows, weights.data(), bias.data(), units, fast.data());
    convolve_plain(windows, weights.data(), bias.data(), units, plain.data());
    EXPECT_EQ(fast, plain);
    const auto by_the_book = [&](int y, int x, int unit) {
      int sum = 0;
      for (int k = 0; k < 9 * kFrom; ++k) {
        const int row = 2 * y + k / (3 * kFrom), column = 2 * x + k / kFrom % 3;
        sum += cells[row * kRow + column * kFrom + k % kFrom] *
               weights[k / 2 * 2 * units + 2 * unit + k % 2];
      }
      const float value = bias[unit] + static_cast<float>(sum) / (kInputUnits * kWeightUnits);
      return std::max(value, value * kLeak);
    };
    for (int i = 0; i < static_cast<int>(fast.size()); ++i) {
      const int window = i / units;
      ASSERT_EQ(fast[i], by_the_book(window / windows.across, window % windows.across, i % units));
    }
  }
}

// One channel: windows lie two elements apart, and a run of three is read with a fourth.
TEST_P(NetworkKernels, ConvolveOneChannelAsThePlainLoop) {
  simulate::Random random(10);
  std::vector<std::int16_t> cells(33 * 33 + 1), weights(12 * 16);
  for (auto* values : {&cells, &weights})
    for (std::int16_t& value : *values) value = static_cast<std::int16_t>(900 * random.normal());
  const std::vector<float> bias(16, 0.5F);
  std::vector<float> fast(16 * 16 * 16), plain(fast.size());
  const Windows windows{.first = cells.data(),
                        .rows = 16,
                        .across = 16,
                        .step = 2,
                        .row_step = 66,
                        .runs = 3,
                        .run_pairs = 2,
                        .run_step = 33};
  convolve(windows, weights.data(), bias.data(), 16, fast.data());
  convolve_plain(windows, weights.data(), bias.data(), 16, plain.data());
  EXPECT_EQ(fast, plain);
}

TEST_P(NetworkKernels, QuantiseAsThePlainLoop) {
  simulate::Random random(8);
  std::vector<float> in(96);
  for (float& value : in) value = 3 * random.normal();
  std::vector<std::int16_t> fast(96), plain(96);
  quantise(in.data(), 96, fast.data());
  quantise_plain(in.data(), 96, plain.data());
  EXPECT_EQ(fast, plain);
}

TEST_P(NetworkKernels, ReadPatchesAsThePlainLoops) {
  for (int seed = 0; seed < 40; ++seed) {
    simulate::Random random(seed, 5);
    std::vector<std::uint16_t> sums(2000);
    for (std::size_t i = 1; i < sums.size(); ++i)
      sums[i] = static_cast<std::uint16_t>(sums[i - 1] + static_cast<int>(random.uniform(0, 894)));
    PatchColumns columns{.first = random.uniform(-100, 1100),
                         .cell = random.uniform(0.2F, 73),
                         .least = -500,
                         .last = 1498};
    PatchCells fast, plain;
    for (int y = 0; y < kPatchSide; ++y) {
      columns.first += 0.37F;
      add_cells(sums.data() + 500, columns, fast.sums[y].data());
      add_cells_plain(sums.data() + 500, columns, plain.sums[y].data());
      fast.factors[y] = plain.factors[y] = random.uniform(0.2F, 0.3F) / columns.cell;
    }
    ASSERT_TRUE(fast.sums == plain.sums);
    std::array<std::int8_t, kPatchSide * kPatchSide> levels, plain_levels;
    standardise_cells(fast, -32, 0.06F, levels.data());
    standardise_cells_plain(plain, -32, 0.06F, plain_levels.data());
    EXPECT_EQ(levels, plain_levels);
  }
}

TEST_P(NetworkKernels, StandardiseAsThePlainLoop) {
  simulate::Random random(7);
  std::vector<float> in(205), mean(205), scale(205);
  for (auto* values : {&in, &mean, &scale})
    for (float& value : *values) value = 3 * random.normal();
  std::vector<std::int16_t> fast(205), plain(205);
  standardise(in.data(), 205, mean.data(), scale.data(), 4, fast.data());
  standardise_plain(in.data(), 205, mean.data(), scale.data(), 4, plain.data());
  EXPECT_EQ(fast, plain);
}

}  // namespace
}  // namespace bole
