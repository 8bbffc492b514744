#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "detect/contrast/band_kernels.h"
#include "detect/contrast/bands.h"
#include "detect/contrast/edge_kernels.h"
#include "detect/contrast/edge_search.h"
#include "detect/contrast/template_kernels.h"
#include "detect/network/foot_kernels.h"
#include "detect/network/grid_kernels.h"
#include "detect/network/row_contrasts.h"
#include "each_target.h"
#include "simulate/noise.h"

namespace bole {
namespace {

class Kernels : public EachTarget {};

INSTANTIATE_TEST_SUITE_P(All, Kernels, each_target(), target_name);

std::vector<std::uint16_t> running_sums(int count, simulate::Random& random) {
  std::vector<std::uint16_t> sums(count);
  std::uint16_t total = 0;
  for (auto& sum : sums) {
    sum = total;
    total = static_cast<std::uint16_t>(total + static_cast<int>(random.uniform(532, 1426)));
  }
  return sums;
}

// Bands in which an edge can be made out here and there.
struct RoughBands {
  static constexpr int kCount = 61, kPitch = 700;
  std::vector<std::uint16_t> sums;

  explicit RoughBands(std::uint64_t seed, int bands_a_column = 4) {
    simulate::Random random(seed);
    for (int band = 0; band < kCount; ++band) {
      std::uint16_t total = 0;
      for (int x = 0; x < kPitch; ++x) {
        sums.push_back(total);
        const float level = x > 300 + band / bands_a_column ? 1000.0F : 940.0F;
        total = static_cast<std::uint16_t>(total + static_cast<int>(level + 60 * random.normal()));
      }
    }
  }
  EdgeBands bands(int flank) const {
    return {.sums = sums.data(),
            .pitch = kPitch,
            .count = kCount,
            .horizon = 23,
            .first_row = -230.5F,
            .row_step = 4,
            .flank = flank};
  }
};

TEST_P(Kernels, SumBandsAsThePlainLoops) {
  simulate::Random random(5);
  for (const int width : {7, 64, 333}) {
    std::vector<std::uint8_t> pixels(4 * width);
    for (auto& pixel : pixels) pixel = static_cast<std::uint8_t>(random.uniform(0, 255.9F));
    const std::uint8_t* rows[4];
    for (int i = 0; i < 4; ++i) rows[i] = pixels.data() + i * width;
    std::vector<std::uint16_t> fast(width), plain(width), shifted(width), shifted_plain(width);
    sum_four_rows(rows, width, fast.data());
    sum_four_rows_plain(rows, width, plain.data());
    EXPECT_EQ(fast, plain);
    shift_sums(fast.data(), width, 65000, shifted.data());
    shift_sums_plain(fast.data(), width, 65000, shifted_plain.data());
    EXPECT_EQ(shifted, shifted_plain);
  }
}

TEST_P(Kernels, ThinSumsAsThePlainLoops) {
  simulate::Random random(7);
  const auto sums = running_sums(4000, random);
  for (const int step : {2, 4}) {
    std::vector<std::uint16_t> fast(777 + kTemplateChunk), plain(777);
    thin_sums(sums.data(), step, 777, fast.data());
    thin_sums_plain(sums.data(), step, 777, plain.data());
    fast.resize(777);
    EXPECT_EQ(fast, plain) << step;
  }
}

TEST_P(Kernels, RespondToEdgesAsThePlainLoops) {
  constexpr int kCount = 1000;
  simulate::Random random(1);
  const auto sums = running_sums(4000, random);
  for (const int flank : {2, 5, 7, 28}) {
    const auto factor = static_cast<std::int16_t>(32768 * kFullResponse / 51.2 / flank);
    // [0]: below the horizon.
    std::array<std::vector<std::uint8_t>, 4> fast, plain;
    for (auto& responses : fast) responses.resize(kCount + kTemplateChunk);
    for (auto& responses : plain) responses.resize(kCount);
    const auto above = [](auto& out) {
      return ResponsesAbove{out[1].data(), {out[2].data(), out[3].data()}};
    };
    edge_responses(sums.data() + 300, flank, factor, kCount, fast[0].data());
    edge_responses_above(sums.data() + 300, flank, factor, kCount, above(fast));
    edge_responses_plain(sums.data() + 300, flank, factor, kCount, plain[0].data());
    edge_responses_above_plain(sums.data() + 300, flank, factor, kCount, above(plain));
    for (auto& responses : fast) responses.resize(kCount);
    EXPECT_EQ(fast, plain) << flank;
    const auto [least, most] = std::ranges::minmax(plain[0]);
    EXPECT_EQ(least, kNoResponse - kFullResponse) << flank;
    EXPECT_EQ(most, kNoResponse + kFullResponse) << flank;
  }
}

TEST_P(Kernels, FindPeaksAsThePlainLoops) {
  simulate::Random random(6);
  std::vector<std::int16_t> evidence(1000);
  for (auto& value : evidence) value = static_cast<std::int16_t>(random.uniform(0, 90));
  for (const int reach : {1, 2, 9}) {
    std::vector<int> fast(777), plain(777);
    fast.resize(find_peaks(evidence.data() + 20, 777, 64, reach, fast.data()));
    plain.resize(find_peaks_plain(evidence.data() + 20, 777, 64, reach, plain.data()));
    EXPECT_EQ(fast, plain);
    EXPECT_GT(fast.size(), 5U);
  }
}

TEST_P(Kernels, SumEvidenceAsThePlainLoops) {
  simulate::Random random(2);
  constexpr int kBands = 97, kCount = 333, kPitch = 600;
  std::vector<std::uint8_t> responses[3];
  for (auto& kind : responses) {
    kind.resize(kBands * kPitch);
    for (auto& response : kind) {
      const float value = random.uniform(-kFullResponse, kFullResponse);
      response = static_cast<std::uint8_t>(
          kNoResponse + (random.chance(0.4F) ? kFullResponse : static_cast<int>(value)));
    }
  }
  std::vector<std::int16_t> results[8];
  for (auto& result : results) result.assign(kCount + kTemplateChunk, -1);
  EvidenceSums sums{.responses = responses[0].data(),
                    .either_sign = {responses[1].data(), responses[2].data()},
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
    plain ? sum_evidence_plain(sums) : sum_evidence(sums);
  }
  for (int k = 0; k < 4; ++k)
    for (int i = 0; i < kCount; ++i)
      ASSERT_EQ(results[k][i], results[4 + k][i]) << k << " at " << i;
}

TEST_P(Kernels, FindEdgesAsThePlainLoops) {
  for (int seed = 0; seed < 80; ++seed) {
    const RoughBands rough(seed, seed % 3 == 0 ? RoughBands::kCount : 4);
    const EdgeBands bands = rough.bands(2 + seed % 7);
    const EdgeSearch search{.first_column = 280 + seed % 30,
                            .reach = 2 + seed % 9,
                            .foot = bands.count + seed % 20,
                            .sign = seed % 5 == 0 ? -1 : 1,
                            .limit = 56};
    EXPECT_EQ(find_edge(bands, search), find_edge_plain(bands, search)) << seed;
  }
}

TEST_P(Kernels, PlaceEdgesAsThePlainLoops) {
  for (const int flank : {2, 3, 5}) {
    const RoughBands rough(flank);
    const EdgeLine line{316, 0.06F};
    EdgePlaces fast, plain;
    place_edge(rough.bands(flank), line, 1, 9 * flank, 300, fast);
    place_edge_plain(rough.bands(flank), line, 1, 9 * flank, 300, plain);
    EXPECT_EQ(fast.found, plain.found);
    EXPECT_GT(fast.found, 20);
    ASSERT_EQ(fast.count, plain.count);
    for (int i = 0; i < fast.count; ++i) {
      ASSERT_EQ(fast.weight[i], plain.weight[i]) << i;
      if (fast.weight[i] == 0) continue;
      ASSERT_EQ(fast.row[i], plain.row[i]) << i;
      ASSERT_EQ(fast.column[i], plain.column[i]) << i;
    }
    const LineSums sums = sum_places(fast, line, 5), same = sum_places_plain(plain, line, 5);
    EXPECT_EQ(sums.w, same.w);
    EXPECT_EQ(sums.row, same.row);
    EXPECT_EQ(sums.row_row, same.row_row);
    EXPECT_EQ(sums.error, same.error);
    EXPECT_EQ(sums.row_error, same.row_error);
    EXPECT_EQ(sums.error_error, same.error_error);
  }
}

TEST_P(Kernels, RespondAlongEdgesAsThePlainLoops) {
  const RoughBands rough(1);
  const EdgeBands bands = rough.bands(4);
  const EdgeLine left{280, 0.02F}, right{316, 0.06F};
  const EdgeResponses fast = respond_along(bands, left, right, 225);
  const EdgeResponses plain = respond_along_plain(bands, left, right, 225);
  EXPECT_EQ(fast.below, plain.below);
  EXPECT_EQ(fast.above, plain.above);
  EXPECT_EQ(fast.agree_below, plain.agree_below);
  EXPECT_EQ(fast.agree_above, plain.agree_above);
}

TEST_P(Kernels, JoinEdgesAsThePlainLoops) {
  const RoughBands rough(1);
  const EdgeBands bands = rough.bands(4);
  const EdgeLine left{280, 0.02F}, right{316, 0.06F};
  for (const float full : {225.0F, -225.0F}) {
    BandValues fast, plain;
    join_edges(bands, left, right, full, fast);
    join_edges_plain(bands, left, right, full, plain);
    for (int i = 0; i < bands.count; ++i) ASSERT_EQ(fast[i], plain[i]) << i;
  }
}

TEST_P(Kernels, TellContrastsOfRowsAsThePlainLoop) {
  simulate::Random random(5);
  std::array<float, TrunkFeatures::kGrid> grid;
  for (float& value : grid) value = random.normal();
  std::fill_n(grid.begin(), 2 * TrunkFeatures::kAcross, 0.7F);
  std::array<float, TrunkFeatures::kRowContrasts> fast, plain;
  const RowLevels levels = row_contrasts(0.1F, grid.data(), fast.data());
  const RowLevels same = row_contrasts_plain(0.1F, grid.data(), plain.data());
  EXPECT_EQ(fast, plain);
  for (int h = 0; h < TrunkFeatures::kHeights; ++h) {
    EXPECT_EQ(levels.mean[h], same.mean[h]) << h;
    EXPECT_EQ(levels.full[h], same.full[h]) << h;
  }
}

TEST_P(Kernels, ReadCellsAsThePlainLoops) {
  const RoughBands rough(2);
  constexpr int kCoarse = RoughBands::kPitch / Bands::kCoarse;
  std::vector<std::int32_t> coarse;
  for (int band = 0; band < RoughBands::kCount; ++band) {
    const std::uint16_t* sums = rough.sums.data() + band * RoughBands::kPitch;
    std::int32_t total = 0;
    for (int k = 0; k < kCoarse; ++k) {
      coarse.push_back(total);
      total +=
          static_cast<std::uint16_t>(sums[(k + 1) * Bands::kCoarse] - sums[k * Bands::kCoarse]);
    }
  }
  const auto columns = [&](float width, bool wide) {
    CellColumns cells{.sums = rough.sums.data() + 40,
                      .pitch = RoughBands::kPitch,
                      .coarse = wide ? coarse.data() : nullptr,
                      .coarse_pitch = kCoarse,
                      .margin = 40,
                      .bands = RoughBands::kCount,
                      .middle = 300.3F,
                      .lean = -0.07F,
                      .borders = {},
                      .factors = {}};
    for (int i = 0; i < kGridLanes; ++i)
      cells.borders[i] = width * static_cast<float>(std::min(i, kGridAcross) - 6);
    for (int i = 0; i < kGridAcross; ++i) cells.factors[i] = 0.001F * static_cast<float>(i + 1);
    return cells;
  };
  std::array<CellRows, kGridHeights> rows;
  for (int h = 0; h < kGridHeights; ++h)
    rows[h] = {4 * h, 4 * h + h * h / 6, 0.05F * static_cast<float>(h), 0.7F, 0.3F};
  const auto expect_equal = [](const GridValues& a, const GridValues& b) {
    for (int h = 0; h < kGridHeights; ++h)
      for (int i = 0; i < kGridAcross; ++i) ASSERT_EQ(a[h][i], b[h][i]) << h << " " << i;
  };
  GridValues fast, plain, whole;
  for (const float width : {0.6F, 3.3F, 9.7F, 41.7F}) {
    for (const bool wide : {false, true}) {
      const GridStatistics of_fast = read_cells(columns(width, wide), rows, fast);
      const GridStatistics of_plain = read_cells_plain(columns(width, wide), rows, plain);
      expect_equal(fast, plain);
      EXPECT_EQ(of_fast.mean, of_plain.mean);
      EXPECT_EQ(of_fast.spread, of_plain.spread);
      if (!wide) whole = fast;
    }
    expect_equal(fast, whole);  // narrow cells need no whole sums
  }
}

TEST_P(Kernels, ReadFeetAsThePlainLoops) {
  simulate::Random random(8);
  const PanoramaGeometry geometry{.columns = 700, .width = 700, .rows = 300};
  std::vector<std::uint8_t> pixels(700 * 300);
  for (auto& pixel : pixels) pixel = static_cast<std::uint8_t>(random.uniform(0, 255.9F));
  const PanoramaView panorama{&geometry, pixels.data(), 700};
  std::vector<float> log(1024);
  for (float& value : log) value = random.normal();
  for (const float unit : {0.8F, 1.0F, 1.9F, 3.1F, 5.0F}) {
    for (const float row : {5.0F, 120.3F, 297.0F}) {
      for (const float middle : {2.5F, 333.3F, 690.0F}) {
        for (const float width : {3.2F, 20.0F, 150.0F}) {
          for (const bool wraps : {false, true}) {
            const FootPlace place{row, middle, 0.09F, width, unit};
            FootLines fast, plain;
            read_foot_lines(panorama, wraps, log.data(), place, fast);
            read_foot_lines_plain(panorama, wraps, log.data(), place, plain);
            EXPECT_EQ(fast.at, plain.at) << row << " " << middle << " " << width << " " << unit;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace bole
