#include "detect/network/row_contrasts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>

// Vectors of scalable length are left out: they cannot stand in structures.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detect/network/row_contrasts.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef BOLE_DETECT_ROW_CONTRASTS_ONCE
#define BOLE_DETECT_ROW_CONTRASTS_ONCE
namespace bole {
namespace {

using F = TrunkFeatures;

constexpr float kLeastSpread = 0.04F;     // of log brightness, that is made full contrast
constexpr float kLeastLogSpread = 0.02F;  // that is told apart from less

// One number of each row of cells side by side.
constexpr int kLanes = RowLevels::kLanes;
static_assert(F::kHeights <= kLanes);
using Rows = std::array<float, kLanes>;

struct RowBuffers {
  alignas(64) std::array<Rows, F::kAcross> cells{};
  alignas(64) std::array<Rows, F::kRowNumbers> numbers;
  alignas(64) Rows within;
};

// log x = e log 2 + log m, x = 2^e m, m from three quarters on; log m from the series of atanh.
constexpr std::int32_t kThreeQuarters = 0x3f400000;
constexpr float kLogOf2 = 0.69314718F, kSeries[] = {1 / 3.0F, 1 / 5.0F, 1 / 7.0F};

float log_plain(float x) {
  const std::int32_t off = std::bit_cast<std::int32_t>(x) - kThreeQuarters;
  const float m = std::bit_cast<float>((off & 0x7fffff) + kThreeQuarters);
  const float s = (m - 1) / (m + 1), s2 = s * s;
  const float series = 1 + (kSeries[0] + (kSeries[1] + kSeries[2] * s2) * s2) * s2;
  return static_cast<float>(off >> 23) * kLogOf2 + (s + s) * series;
}

}  // namespace
}  // namespace bole
#endif

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kLanes>;
using Ints = hn::RebindToSigned<Floats>;
using Vector = hn::Vec<Floats>;

struct Moments {
  Vector mean, spread;
};

// Over the cells [first, last) of some rows.
HWY_INLINE Moments Over(const RowBuffers& buffers, int row, int first, int last) {
  const Floats d;
  auto sum = hn::Zero(d), squares = hn::Zero(d);
  for (int i = first; i < last; ++i) {
    const auto cell = hn::Load(d, buffers.cells[i].data() + row);
    sum = hn::Add(sum, cell);
    squares = hn::Add(squares, hn::Mul(cell, cell));
  }
  const auto share = hn::Set(d, 1 / static_cast<float>(last - first));
  const auto mean = hn::Mul(sum, share);
  const auto variance = hn::Sub(hn::Mul(squares, share), hn::Mul(mean, mean));
  return {mean, hn::Sqrt(hn::Max(hn::Zero(d), variance))};
}

HWY_INLINE Vector Log(Vector x) {
  const Floats d;
  const Ints di;
  const auto from = hn::Set(di, kThreeQuarters), one = hn::Set(di, 0x7fffff);
  const auto off = hn::Sub(hn::BitCast(di, x), from);
  const auto m = hn::BitCast(d, hn::Add(hn::And(off, one), from));
  const auto s = hn::Div(hn::Sub(m, hn::Set(d, 1.0F)), hn::Add(m, hn::Set(d, 1.0F)));
  const auto s2 = hn::Mul(s, s);
  auto series = hn::Set(d, kSeries[2]);
  series = hn::Add(hn::Set(d, kSeries[1]), hn::Mul(series, s2));
  series = hn::Add(hn::Set(d, kSeries[0]), hn::Mul(series, s2));
  series = hn::Add(hn::Set(d, 1.0F), hn::Mul(series, s2));
  const auto whole = hn::Mul(hn::ConvertTo(d, hn::ShiftRight<23>(off)), hn::Set(d, kLogOf2));
  return hn::Add(whole, hn::Mul(hn::Add(s, s), series));
}

void TellContrasts(float unit, RowBuffers& buffers, RowLevels& levels) {
  const Floats d;
  const auto least = hn::Set(d, kLeastSpread / unit);
  for (int row = 0; row < kLanes; row += static_cast<int>(hn::Lanes(d))) {
    const auto cell = [&](int i) { return hn::Load(d, buffers.cells[i].data() + row); };
    const auto put = [&](int which, Vector value) {
      hn::Store(value, d, buffers.numbers[which].data() + row);
    };
    const Moments all = Over(buffers, row, 0, F::kAcross), within = Over(buffers, row, 4, 8);
    const auto full = hn::Max(all.spread, least);
    const auto half = hn::Div(hn::Set(d, 0.5F), full);
    // Beside the edge, not upon it: it is never quite where the outline has it.
    const auto edge = [&](int a, int b, int c, int e) {
      const auto beside = hn::Add(cell(a), cell(b)), inside = hn::Add(cell(c), cell(e));
      return hn::Mul(half, hn::Sub(beside, inside));
    };
    const auto left = edge(1, 2, 4, 5), right = edge(9, 10, 6, 7);
    put(0, all.mean);
    put(1, Log(hn::Max(hn::Mul(all.spread, hn::Set(d, unit)), hn::Set(d, kLeastLogSpread))));
    put(2, hn::Abs(left));
    put(3, hn::Abs(right));
    put(4, hn::Min(hn::Abs(left), hn::Abs(right)));
    put(5, hn::Mul(left, right));
    put(6, hn::Div(within.spread, full));
    hn::Store(within.mean, d, buffers.within.data() + row);
    hn::StoreU(all.mean, d, levels.mean.data() + row);
    hn::StoreU(full, d, levels.full.data() + row);
  }
}

}  // namespace bole::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bole {

HWY_EXPORT(TellContrasts);

RowLevels row_contrasts(float unit, const float* grid, float* out) {
  RowBuffers buffers;
  for (int h = 0; h < F::kHeights; ++h)
    for (int i = 0; i < F::kAcross; ++i) buffers.cells[i][h] = grid[h * F::kAcross + i];
  RowLevels levels;
  HWY_DYNAMIC_DISPATCH(TellContrasts)(unit, buffers, levels);
  for (const Rows& number : buffers.numbers) out = std::copy_n(number.begin(), F::kHeights, out);
  for (int h = 0; h + 1 < F::kHeights; ++h)
    *out++ = std::abs(buffers.within[h + 1] - buffers.within[h]);
  return levels;
}

RowLevels row_contrasts_plain(float unit, const float* grid, float* out) {
  RowLevels levels;
  std::array<float, F::kHeights> inside;
  for (int h = 0; h < F::kHeights; ++h, grid += F::kAcross) {
    const auto moments = [grid](int first, int last) -> std::array<float, 2> {
      float sum = 0, squares = 0;
      for (int i = first; i < last; ++i) {
        sum += grid[i];
        squares += grid[i] * grid[i];
      }
      const float share = 1 / static_cast<float>(last - first), mean = sum * share;
      return {mean, std::sqrt(std::max(0.0F, squares * share - mean * mean))};
    };
    const auto [mean, spread] = moments(0, F::kAcross);
    const auto [mean_within, spread_within] = moments(4, 8);
    const float full = std::max(spread, kLeastSpread / unit), half = 0.5F / full;
    const float left = half * ((grid[1] + grid[2]) - (grid[4] + grid[5]));
    const float right = half * ((grid[9] + grid[10]) - (grid[6] + grid[7]));
    const std::array<float, F::kRowNumbers> numbers = {
        mean,
        log_plain(std::max(spread * unit, kLeastLogSpread)),
        std::abs(left),
        std::abs(right),
        std::min(std::abs(left), std::abs(right)),
        left * right,
        spread_within / full};
    for (int k = 0; k < F::kRowNumbers; ++k) out[k * F::kHeights + h] = numbers[k];
    levels.mean[h] = mean;
    levels.full[h] = full;
    inside[h] = mean_within;
  }
  out += F::kRowNumbers * F::kHeights;
  for (int h = 0; h + 1 < F::kHeights; ++h) *out++ = std::abs(inside[h + 1] - inside[h]);
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
#endif  // HWY_ONCE
