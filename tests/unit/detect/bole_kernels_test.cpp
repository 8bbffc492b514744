#include <gtest/gtest.h>

#include <vector>

#include "detect/dense_layer.h"
#include "detect/edge_kernels.h"
#include "detect/template_kernels.h"
#include "simulate/noise.h"

namespace bole {
namespace {

std::vector<std::int32_t> running_sums(int count, simulate::Random& random) {
  std::vector<std::int32_t> sums(count);
  std::int32_t total = 0;
  for (auto& sum : sums) {
    sum = total;
    total += static_cast<int>(random.uniform(500, 1430));
  }
  return sums;
}

TEST(TemplateKernels, RespondAsThePlainLoops) {
  simulate::Random random(1);
  const auto sums = running_sums(4000, random);
  for (const auto& [flank, step] : {std::pair(2, 1), {5, 1}, {8, 2}, {18, 4}, {28, 4}}) {
    std::vector<std::int16_t> fast(1000 / step + kTemplateChunk), plain(fast.size());
    const float scale = 64.0F / (51.2F * static_cast<float>(flank));
    edge_responses(sums.data() + 300, flank, step, scale, 1000 / step, fast.data());
    edge_responses_plain(sums.data() + 300, flank, step, scale, 1000 / step, plain.data());
    for (int i = 0; i < 1000 / step; ++i) ASSERT_EQ(fast[i], plain[i]) << flank << " at " << i;
  }
}

TEST(TemplateKernels, SumColumnsAsThePlainLoops) {
  simulate::Random random(2);
  constexpr int kBands = 97, kCount = 333, kPitch = 600;
  std::vector<std::int16_t> responses(kBands * kPitch);
  for (auto& response : responses)
    response = static_cast<std::int16_t>(random.chance(0.4F) ? 64 : random.uniform(-64, 64));
  std::vector<std::int16_t> results[8];
  for (auto& result : results) result.assign(kCount + kTemplateChunk, -1);
  ColumnSums sums{.responses = responses.data(),
                  .pitch = kPitch,
                  .across = 17,
                  .horizon = 29,
                  .first_foot = 20,
                  .last_foot = 80,
                  .count = kCount};
  for (const int plain : {0, 1}) {
    for (const int polarity : {0, 1}) {
      sums.evidence[polarity] = results[4 * plain + 2 * polarity].data();
      sums.foot[polarity] = results[4 * plain + 2 * polarity + 1].data();
    }
    plain ? sum_columns_plain(sums) : sum_columns(sums);
  }
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < kCount; ++i)
      ASSERT_EQ(results[k][i], results[4 + k][i]) << k << " at " << i;
}

TEST(DenseLayer, AddsAsThePlainLoops) {
  simulate::Random random(4);
  std::vector<float> in(205), weights(205 * 96), fast(96, 0.5F), plain(96, 0.5F);
  for (float& value : in) value = random.normal();
  for (float& weight : weights) weight = random.normal();
  for (const int units : {48, 96}) {
    add_dense(in.data(), 205, weights.data(), units, fast.data());
    add_dense_plain(in.data(), 205, weights.data(), units, plain.data());
    EXPECT_EQ(fast, plain);
  }
}

TEST(EdgeKernels, SumEdgesAsThePlainLoops) {
  simulate::Random random(3);
  constexpr int kBands = 40, kPitch = 300;
  std::vector<std::int32_t> sums;
  for (int band = 0; band < kBands; ++band) {
    const auto row = running_sums(kPitch, random);
    sums.insert(sums.end(), row.begin(), row.end());
  }
  std::array<std::array<std::uint8_t, EdgeWindow::kSlopes>, EdgeWindow::kMostBands> starts{};
  for (auto& band : starts)
    for (auto& start : band) start = static_cast<std::uint8_t>(random.uniform(0, 32.9F));
  for (const int flank : {2, 5, 8}) {
    const EdgeWindow window{.sums = sums.data() + 100,
                            .pitch = kPitch,
                            .bands = kBands,
                            .horizon = 13,
                            .flank = flank,
                            .sign = flank == 5 ? -1 : 1,
                            .limit = 56,
                            .starts = &starts};
    EdgeTotals fast, plain;
    sum_edges(window, fast);
    sum_edges_plain(window, plain);
    EXPECT_EQ(fast, plain);
  }
}

}  // namespace
}  // namespace bole
