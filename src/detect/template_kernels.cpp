#include "detect/template_kernels.h"

#include <algorithm>
#include <bit>
#include <cstdlib>

// Vectors of scalable length are left out: they cannot stand in structures.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detect/template_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Sums = hn::ScalableTag<std::uint16_t>;

// Every kStep-th of the elements from `from` on.
template <int kStep>
HWY_INLINE hn::Vec<Sums> LoadEvery(const std::uint16_t* from) {
  const Sums d;
  if constexpr (kStep == 1) {
    return hn::LoadU(d, from);
  } else if constexpr (kStep == 2) {
    hn::Vec<Sums> even, odd;
    hn::LoadInterleaved2(d, from, even, odd);
    return even;
  } else {
    hn::Vec<Sums> first, second, third, fourth;
    hn::LoadInterleaved4(d, from, first, second, third, fourth);
    return first;
  }
}

template <int kStep>
void RespondEvery(const std::uint16_t* sum, int flank, std::uint16_t factor, int count,
                  std::int16_t* out) {
  const Sums d;
  const hn::RebindToSigned<Sums> di;
  const auto by = hn::Set(d, factor);
  const auto most = hn::Set(d, static_cast<std::uint16_t>(kFullResponse));
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
    const std::uint16_t* at = sum + i * kStep;
    const auto middle = LoadEvery<kStep>(at);
    const auto bend = hn::BitCast(di, hn::Sub(hn::Sub(LoadEvery<kStep>(at + flank), middle),
                                              hn::Sub(middle, LoadEvery<kStep>(at - flank))));
    const auto size = hn::Min(most, hn::MulHigh(hn::BitCast(d, hn::Abs(bend)), by));
    const auto negative = hn::ShiftRight<15>(bend);
    hn::StoreU(hn::Sub(hn::Xor(hn::BitCast(di, size), negative), negative), di, out + i);
  }
}

void EdgeResponses(const std::uint16_t* sum, int flank, int step, std::uint16_t factor, int count,
                   std::int16_t* out) {
  if (step == 1) {
    RespondEvery<1>(sum, flank, factor, count, out);
  } else if (step == 2) {
    RespondEvery<2>(sum, flank, factor, count, out);
  } else {
    RespondEvery<4>(sum, flank, factor, count, out);
  }
}

using Narrow = hn::CappedTag<std::int16_t, kTemplateChunk>;
using Values = hn::Vec<Narrow>;

// The running and the highest sum of a vector of columns.
struct Run {
  Values sum, best, foot;

  HWY_INLINE void Add(Values value, Values end, bool may_end) {
    const Narrow d;
    sum = hn::Max(hn::Add(sum, value), hn::Zero(d));
    if (!may_end) return;
    foot = hn::IfThenElse(hn::Gt(sum, best), end, foot);
    best = hn::Max(best, sum);
  }
};

HWY_INLINE Values Joined(Values l, Values r, Values against) {
  return hn::Sub(hn::Add(hn::ShiftRight<2>(hn::Add(l, r)), hn::ShiftRight<1>(hn::Min(l, r))),
                 against);
}

// value * factor / 2^shift, rounded down; a product by a constant would become many additions.
template <int kFactor, int kShift>
HWY_INLINE Values Scaled(Values value) {
  constexpr int kHigh = kFactor * (1 << (16 - kShift));
  static_assert(kHigh == static_cast<std::int16_t>(kHigh));
  return hn::MulHigh(value, hn::Set(Narrow(), static_cast<std::int16_t>(kHigh)));
}

// The same where the sign counts for less.
HWY_INLINE Values JoinedAbove(Values l, Values r) {
  const Narrow d;
  const auto soft = [&](Values v) { return hn::Max(v, Scaled<-11, 5>(hn::Add(v, v))); };
  const auto any_sign = Joined(soft(l), soft(r), hn::Set(d, 35));
  const auto right_sign = Joined(l, r, hn::Set(d, 24));
  return hn::Max(Scaled<13, 5>(any_sign), Scaled<5, 4>(hn::Add(right_sign, right_sign)));
}

void SumColumns(const ColumnSums& s) {
  const Narrow d;
  const auto zero = hn::Zero(d);
  for (int start = 0; start < s.count; start += static_cast<int>(hn::Lanes(d))) {
    Run dark{zero, zero, zero}, bright{zero, zero, zero};
    for (int band = 0; band < s.last_foot; ++band) {
      const std::int16_t* at = s.responses + static_cast<std::ptrdiff_t>(band) * s.pitch + start;
      const auto left = hn::LoadU(d, at), right = hn::LoadU(d, at + s.across);
      const auto end = hn::Set(d, static_cast<std::int16_t>(band + 1));
      const bool may_end = band + 1 >= s.first_foot;
      if (band < s.horizon) {
        dark.Add(JoinedAbove(hn::Neg(left), right), end, may_end);
        bright.Add(JoinedAbove(left, hn::Neg(right)), end, may_end);
      } else {
        const auto against = hn::Set(d, 19);
        dark.Add(Joined(hn::Neg(left), right, against), end, may_end);
        bright.Add(Joined(left, hn::Neg(right), against), end, may_end);
      }
    }
    hn::StoreU(dark.best, d, s.evidence[0] + start);
    hn::StoreU(dark.foot, d, s.foot[0] + start);
    hn::StoreU(bright.best, d, s.evidence[1] + start);
    hn::StoreU(bright.foot, d, s.foot[1] + start);
  }
}

int FindPeaks(const std::int16_t* evidence, int count, int least, int reach, int* places) {
  const Narrow d;
  const auto enough = hn::Set(d, static_cast<std::int16_t>(least - 1));
  int found = 0;
  for (int start = 0; start < count; start += static_cast<int>(hn::Lanes(d))) {
    const std::int16_t* at = evidence + start;
    const auto here = hn::LoadU(d, at);
    auto peak = hn::Gt(here, enough);
    for (int k = 1; k <= reach && !hn::AllFalse(d, peak); ++k) {
      const auto before = hn::LoadU(d, at - k), after = hn::LoadU(d, at + k);
      peak = hn::And(peak, hn::AndNot(hn::Gt(before, here), hn::Gt(here, after)));
    }
    if (hn::AllFalse(d, peak)) continue;
    std::uint64_t bits = 0;
    hn::StoreMaskBits(d, peak, reinterpret_cast<std::uint8_t*>(&bits));
    for (; bits != 0; bits &= bits - 1) {
      const int place = start + std::countr_zero(bits);
      if (place < count) places[found++] = place;
    }
  }
  return found;
}

}  // namespace bole::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bole {

HWY_EXPORT(EdgeResponses);
HWY_EXPORT(SumColumns);
HWY_EXPORT(FindPeaks);

void edge_responses(const std::uint16_t* sum, int flank, int step, std::uint16_t factor, int count,
                    std::int16_t* out) {
  HWY_DYNAMIC_DISPATCH(EdgeResponses)(sum, flank, step, factor, count, out);
}

void sum_columns(const ColumnSums& sums) { HWY_DYNAMIC_DISPATCH(SumColumns)(sums); }

void edge_responses_plain(const std::uint16_t* sum, int flank, int step, std::uint16_t factor,
                          int count, std::int16_t* out) {
  for (int i = 0; i < count; ++i) {
    const int x = i * step;
    const auto bend = static_cast<std::int16_t>(sum[x + flank] - 2 * sum[x] + sum[x - flank]);
    const int size = std::min(kFullResponse, std::abs(bend) * factor >> 16);
    out[i] = static_cast<std::int16_t>(bend < 0 ? -size : size);
  }
}

void sum_columns_plain(const ColumnSums& s) {
  const auto soft = [](int v) { return std::max(v, (-11 * v) >> 4); };
  for (int i = 0; i < s.count; ++i) {
    for (const int polarity : {0, 1}) {
      const int sign = polarity == 0 ? 1 : -1;
      int sum = 0, best = 0, foot = 0;
      for (int band = 0; band < s.last_foot; ++band) {
        const std::int16_t* at = s.responses + static_cast<std::ptrdiff_t>(band) * s.pitch + i;
        const int l = -sign * at[0], r = sign * at[s.across];
        const auto joined = [](int a, int b) { return ((a + b) >> 2) + (std::min(a, b) >> 1); };
        int value = joined(l, r) - 19;
        if (band < s.horizon) {
          value =
              std::max(((joined(soft(l), soft(r)) - 35) * 13) >> 5, ((joined(l, r) - 24) * 5) >> 3);
        }
        sum = std::max(0, sum + value);
        if (band + 1 < s.first_foot || sum <= best) continue;
        best = sum;
        foot = band + 1;
      }
      s.evidence[polarity][i] = static_cast<std::int16_t>(best);
      s.foot[polarity][i] = static_cast<std::int16_t>(foot);
    }
  }
}

int find_peaks(const std::int16_t* evidence, int count, int least, int reach, int* places) {
  return HWY_DYNAMIC_DISPATCH(FindPeaks)(evidence, count, least, reach, places);
}

int find_peaks_plain(const std::int16_t* evidence, int count, int least, int reach, int* places) {
  int found = 0;
  for (int i = 0; i < count; ++i) {
    bool peak = evidence[i] >= least;
    for (int k = 1; peak && k <= reach; ++k)
      peak = evidence[i] >= evidence[i - k] && evidence[i] > evidence[i + k];
    if (peak) places[found++] = i;
  }
  return found;
}

}  // namespace bole
#endif  // HWY_ONCE
