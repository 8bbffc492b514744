#include "detect/template_kernels.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detect/template_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Wide = hn::ScalableTag<std::int32_t>;

// Every kStep-th of the elements from `from` on.
template <int kStep>
hn::Vec<Wide> LoadEvery(const std::int32_t* from) {
  const Wide d;
  if constexpr (kStep == 1) {
    return hn::LoadU(d, from);
  } else if constexpr (kStep == 2) {
    hn::Vec<Wide> even, odd;
    hn::LoadInterleaved2(d, from, even, odd);
    return even;
  } else {
    hn::Vec<Wide> first, second, third, fourth;
    hn::LoadInterleaved4(d, from, first, second, third, fourth);
    return first;
  }
}

template <int kStep>
void RespondEvery(const std::int32_t* sum, int flank, float scale, int count, std::int16_t* out) {
  const Wide d;
  const hn::RebindToFloat<Wide> df;
  const hn::Rebind<std::int16_t, Wide> d16;
  const auto factor = hn::Set(df, scale);
  const auto most = hn::Set(df, static_cast<float>(kFullResponse));
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
    const std::int32_t* at = sum + i * kStep;
    const auto middle = LoadEvery<kStep>(at);
    const auto bend = hn::Sub(hn::Add(LoadEvery<kStep>(at + flank), LoadEvery<kStep>(at - flank)),
                              hn::Add(middle, middle));
    const auto response = hn::Mul(hn::ConvertTo(df, bend), factor);
    const auto clipped = hn::Min(most, hn::Max(hn::Neg(most), response));
    hn::StoreU(hn::DemoteTo(d16, hn::ConvertTo(d, clipped)), d16, out + i);
  }
}

void EdgeResponses(const std::int32_t* sum, int flank, int step, float scale, int count,
                   std::int16_t* out) {
  if (step == 1) {
    RespondEvery<1>(sum, flank, scale, count, out);
  } else if (step == 2) {
    RespondEvery<2>(sum, flank, scale, count, out);
  } else {
    RespondEvery<4>(sum, flank, scale, count, out);
  }
}

using Narrow = hn::CappedTag<std::int16_t, kTemplateChunk>;
using Values = hn::Vec<Narrow>;

// The running and the highest sum of a vector of columns.
struct Run {
  Values sum, best, foot;

  void Add(Values value, Values end, bool may_end) {
    const Narrow d;
    sum = hn::Max(hn::Add(sum, value), hn::Zero(d));
    if (!may_end) return;
    foot = hn::IfThenElse(hn::Gt(sum, best), end, foot);
    best = hn::Max(best, sum);
  }
};

Values Joined(Values l, Values r, Values against) {
  return hn::Sub(hn::Add(hn::ShiftRight<2>(hn::Add(l, r)), hn::ShiftRight<1>(hn::Min(l, r))),
                 against);
}

// The same where the sign counts for less.
Values JoinedAbove(Values l, Values r) {
  const Narrow d;
  const auto soft = [&](Values v) {
    return hn::Max(v, hn::ShiftRight<4>(hn::Mul(v, hn::Set(d, -11))));
  };
  const auto any_sign = Joined(soft(l), soft(r), hn::Set(d, 35));
  const auto right_sign = Joined(l, r, hn::Set(d, 24));
  return hn::Max(hn::ShiftRight<5>(hn::Mul(any_sign, hn::Set(d, 13))),
                 hn::ShiftRight<3>(hn::Mul(right_sign, hn::Set(d, 5))));
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

}  // namespace bole::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bole {

HWY_EXPORT(EdgeResponses);
HWY_EXPORT(SumColumns);

void edge_responses(const std::int32_t* sum, int flank, int step, float scale, int count,
                    std::int16_t* out) {
  HWY_DYNAMIC_DISPATCH(EdgeResponses)(sum, flank, step, scale, count, out);
}

void sum_columns(const ColumnSums& sums) { HWY_DYNAMIC_DISPATCH(SumColumns)(sums); }

void edge_responses_plain(const std::int32_t* sum, int flank, int step, float scale, int count,
                          std::int16_t* out) {
  constexpr auto kMost = static_cast<float>(kFullResponse);
  for (int i = 0; i < count; ++i) {
    const int x = i * step;
    const float response = static_cast<float>(sum[x + flank] - 2 * sum[x] + sum[x - flank]) * scale;
    out[i] = static_cast<std::int16_t>(std::clamp(response, -kMost, kMost));
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
        if (band < s.horizon)
          value =
              std::max(((joined(soft(l), soft(r)) - 35) * 13) >> 5, ((joined(l, r) - 24) * 5) >> 3);
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

}  // namespace bole
#endif  // HWY_ONCE
