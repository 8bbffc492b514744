#include "detect/contrast/band_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detect/contrast/band_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Sums = hn::ScalableTag<std::uint16_t>;

// Calls work(i) for every vector of `count` elements; the last one ends where they end, and may
// overlap the one before. False where they are fewer than a vector.
template <class Work>
bool for_each_vector(int count, const Work& work) {
  const int lanes = static_cast<int>(hn::Lanes(Sums()));
  if (count < lanes) return false;
  for (int i = 0; i < count - lanes; i += lanes) work(i);
  work(count - lanes);
  return true;
}

void SumFourRows(const std::uint8_t* const rows[4], int width, std::uint16_t* out) {
  const Sums d;
  const hn::Rebind<std::uint8_t, Sums> d8;
  const auto row = [&](int k, int x) { return hn::PromoteTo(d, hn::LoadU(d8, rows[k] + x)); };
  const bool done = for_each_vector(width, [&](int x) {
    hn::StoreU(hn::Add(hn::Add(row(0, x), row(1, x)), hn::Add(row(2, x), row(3, x))), d, out + x);
  });
  if (!done) sum_four_rows_plain(rows, width, out);
}

void ShiftSums(const std::uint16_t* from, int count, std::uint16_t shift, std::uint16_t* to) {
  const Sums d;
  const auto by = hn::Set(d, shift);
  const bool done = for_each_vector(
      count, [&](int i) { hn::StoreU(hn::Add(hn::LoadU(d, from + i), by), d, to + i); });
  if (!done) shift_sums_plain(from, count, shift, to);
}

}  // namespace bole::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bole {

HWY_EXPORT(SumFourRows);
HWY_EXPORT(ShiftSums);

void sum_four_rows(const std::uint8_t* const rows[4], int width, std::uint16_t* out) {
  HWY_DYNAMIC_DISPATCH(SumFourRows)(rows, width, out);
}

void shift_sums(const std::uint16_t* from, int count, std::uint16_t shift, std::uint16_t* to) {
  HWY_DYNAMIC_DISPATCH(ShiftSums)(from, count, shift, to);
}

void sum_four_rows_plain(const std::uint8_t* const rows[4], int width, std::uint16_t* out) {
  for (int x = 0; x < width; ++x)
    out[x] = static_cast<std::uint16_t>(rows[0][x] + rows[1][x] + rows[2][x] + rows[3][x]);
}

void shift_sums_plain(const std::uint16_t* from, int count, std::uint16_t shift,
                      std::uint16_t* to) {
  for (int i = 0; i < count; ++i) to[i] = static_cast<std::uint16_t>(from[i] + shift);
}

}  // namespace bole
#endif  // HWY_ONCE
