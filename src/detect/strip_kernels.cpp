#include "detect/strip_kernels.h"

#include <algorithm>
#include <numeric>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detect/strip_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The three sums go side by side in one number of 64 bits.
std::uint64_t SumStrips(const std::uint8_t* row, const RowStrips& strips) {
  const hn::CappedTag<std::uint8_t, RowStrips::kUnderread + 1> d;
  const hn::Repartition<std::uint64_t, decltype(d)> d64;
  const int lanes = static_cast<int>(hn::Lanes(d));
  auto sums = hn::Zero(d64);
  for (int x = strips.last[2] - lanes; x > strips.first[0] - lanes; x -= lanes) {
    const auto pixels = hn::LoadU(d, row + x);
    const auto strip = [&](int k) {
      const auto from =
          hn::FirstN(d, static_cast<std::size_t>(std::clamp(strips.first[k] - x, 0, lanes)));
      const auto to =
          hn::FirstN(d, static_cast<std::size_t>(std::clamp(strips.last[k] - x, 0, lanes)));
      return hn::SumsOf8(hn::IfThenElseZero(hn::AndNot(from, to), pixels));
    };
    sums = hn::Add(sums, strip(0));
    sums = hn::Add(sums, hn::ShiftLeft<21>(strip(1)));
    sums = hn::Add(sums, hn::ShiftLeft<42>(strip(2)));
  }
  return hn::GetLane(hn::SumOfLanes(d64, sums));
}

// The last vector ends with the pixels; what the one before has summed is left out of it.
int SumPixels(const std::uint8_t* pixels, int count) {
  const hn::CappedTag<std::uint8_t, 32> d;
  const hn::Repartition<std::uint64_t, decltype(d)> d64;
  const int lanes = static_cast<int>(hn::Lanes(d));
  if (count < lanes) return std::accumulate(pixels, pixels + count, 0);
  auto sums = hn::Zero(d64);
  int x = 0;
  for (; x + lanes <= count; x += lanes)
    sums = hn::Add(sums, hn::SumsOf8(hn::LoadU(d, pixels + x)));
  const auto summed = hn::FirstN(d, static_cast<std::size_t>(x + lanes - count));
  const auto rest = hn::IfThenZeroElse(summed, hn::LoadU(d, pixels + count - lanes));
  sums = hn::Add(sums, hn::SumsOf8(rest));
  return static_cast<int>(hn::GetLane(hn::SumOfLanes(d64, sums)));
}

}  // namespace bole::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bole {

HWY_EXPORT(SumStrips);
HWY_EXPORT(SumPixels);

int sum_pixels(const std::uint8_t* pixels, int count) {
  return HWY_DYNAMIC_DISPATCH(SumPixels)(pixels, count);
}

std::array<int, RowStrips::kCount> sum_strips(const std::uint8_t* row, const RowStrips& strips) {
  const std::uint64_t sums = HWY_DYNAMIC_DISPATCH(SumStrips)(row, strips);
  constexpr std::uint64_t kOne = (std::uint64_t{1} << 21) - 1;
  return {static_cast<int>(sums & kOne), static_cast<int>(sums >> 21 & kOne),
          static_cast<int>(sums >> 42)};
}

std::array<int, RowStrips::kCount> sum_strips_plain(const std::uint8_t* row,
                                                    const RowStrips& strips) {
  std::array<int, RowStrips::kCount> sums;
  for (int k = 0; k < RowStrips::kCount; ++k)
    sums[k] = std::accumulate(row + strips.first[k], row + strips.last[k], 0);
  return sums;
}

}  // namespace bole
#endif  // HWY_ONCE
