#include "detect/row_contrasts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>

namespace bole {
namespace {

using F = TrunkFeatures;

constexpr float kLeastSpread = 0.04F;     // of log brightness, that is made full contrast
constexpr float kLeastLogSpread = 0.02F;  // that is told apart from less

// One number of each row of cells: side by side, so that the compiler makes vectors of them.
constexpr int kLanes = RowLevels::kLanes;
static_assert(F::kHeights <= kLanes);
using Rows = std::array<float, kLanes>;

struct Moments {
  Rows mean, spread;
};

// Over the cells [first, last) of each row.
Moments moments(const std::array<Rows, F::kAcross>& cells, int first, int last) {
  Rows sum{}, squares{};
  for (int i = first; i < last; ++i) {
    for (int h = 0; h < kLanes; ++h) {
      sum[h] += cells[i][h];
      squares[h] += cells[i][h] * cells[i][h];
    }
  }
  Moments result;
  const float share = 1 / static_cast<float>(last - first);
  for (int h = 0; h < kLanes; ++h) {
    result.mean[h] = sum[h] * share;
    result.spread[h] = std::max(0.0F, squares[h] * share - result.mean[h] * result.mean[h]);
  }
  for (float& spread : result.spread) spread = std::sqrt(spread);
  return result;
}

// Natural logarithms to 1e-6, of what is positive: x = 2^e m, log m from the series of atanh.
Rows logs(const Rows& x) {
  Rows result;
  for (int h = 0; h < kLanes; ++h) {
    constexpr std::int32_t kThreeQuarters = 0x3f400000;  // m lies in [0.75, 1.5)
    const std::int32_t off = std::bit_cast<std::int32_t>(x[h]) - kThreeQuarters;
    const std::int32_t e = off >> 23;
    const float m = std::bit_cast<float>((off & 0x7fffff) + kThreeQuarters);
    const float s = (m - 1) / (m + 1), s2 = s * s;
    const float series = 2 * s * (1 + s2 * (1 / 3.0F + s2 * (0.2F + s2 * (1 / 7.0F))));
    result[h] = static_cast<float>(e) * 0.69314718F + series;
  }
  return result;
}

}  // namespace

RowLevels row_contrasts(float unit, const float* grid, float* out) {
  std::array<Rows, F::kAcross> cells{};
  for (int h = 0; h < F::kHeights; ++h)
    for (int i = 0; i < F::kAcross; ++i) cells[i][h] = grid[h * F::kAcross + i];
  const Moments all = moments(cells, 0, F::kAcross), within = moments(cells, 4, 8);
  RowLevels levels{.mean = all.mean, .full = {}};
  const float least = kLeastSpread / unit;
  std::array<Rows, F::kRowNumbers> numbers;
  numbers[0] = all.mean;
  Rows spread;
  for (int h = 0; h < kLanes; ++h) {
    levels.full[h] = std::max(all.spread[h], least);
    spread[h] = std::max(all.spread[h] * unit, kLeastLogSpread);
  }
  numbers[1] = logs(spread);
  for (int h = 0; h < kLanes; ++h) {
    // Beside the edge, not upon it: it is never quite where the outline has it.
    const float half = 0.5F / levels.full[h];
    const float left = half * (cells[1][h] + cells[2][h] - cells[4][h] - cells[5][h]);
    const float right = half * (cells[9][h] + cells[10][h] - cells[6][h] - cells[7][h]);
    numbers[2][h] = std::abs(left);
    numbers[3][h] = std::abs(right);
    numbers[4][h] = std::min(numbers[2][h], numbers[3][h]);
    numbers[5][h] = left * right;
    numbers[6][h] = within.spread[h] / levels.full[h];
  }
  for (const Rows& number : numbers) out = std::copy_n(number.begin(), F::kHeights, out);
  for (int h = 0; h + 1 < F::kHeights; ++h) *out++ = std::abs(within.mean[h + 1] - within.mean[h]);
  return levels;
}

void even_rows(const RowLevels& levels, float* grid) {
  for (int h = 0; h < F::kHeights; ++h) {
    const float share = 1 / levels.full[h];
    for (int i = 0; i < F::kAcross; ++i, ++grid) *grid = (*grid - levels.mean[h]) * share;
  }
}

float even_foot(float unit, float* foot) {
  const std::span<float> strips(foot, F::kFoot);
  const float squares = std::inner_product(strips.begin(), strips.end(), strips.begin(), 0.0F);
  const float full =
      std::max(std::sqrt(squares / static_cast<float>(strips.size())), kLeastSpread / unit);
  for (float& value : strips) value = std::clamp(value / full, -4.0F, 4.0F);
  return std::log(full * unit);
}

}  // namespace bole
