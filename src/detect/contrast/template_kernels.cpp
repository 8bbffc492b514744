#include "detect/contrast/template_kernels.h"

#include <algorithm>
#include <bit>
#include <cstdlib>

#include "detect/rounding.h"

// Vectors of scalable length are left out: they cannot stand in structures.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detect/contrast/template_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef BOLE_DETECT_TEMPLATE_KERNELS_ONCE
#define BOLE_DETECT_TEMPLATE_KERNELS_ONCE
namespace bole {
namespace {

// Of a response above the horizon, in units of 2^-15.
constexpr int kRightSign = (1 << 15) * 5 / 8;
constexpr int kEitherSign = (1 << 15) * 13 / 32;
constexpr int kWrongSign = kEitherSign * 11 / 16;

// A band counts for a trunk by what is above these. What has either sign has less against it.
constexpr std::uint16_t kAgainst = kNoResponse + 30;
constexpr std::uint16_t kAgainstAbove = kNoResponse + 24;
constexpr int kNoEitherSign = kNoResponse + 1;

}  // namespace
}  // namespace bole
#endif

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR  // a processor without vectors

void ThinSums(const std::uint16_t* sum, int step, int count, std::uint16_t* out) {
  thin_sums_plain(sum, step, count, out);
}

void EdgeResponses(const std::uint16_t* sum, int flank, std::int16_t factor, int count,
                   std::uint8_t* out) {
  edge_responses_plain(sum, flank, factor, count, out);
}

void EdgeResponsesAbove(const std::uint16_t* sum, int flank, std::int16_t factor, int count,
                        const ResponsesAbove& out) {
  edge_responses_above_plain(sum, flank, factor, count, out);
}

void SumEvidence(const EvidenceSums& sums) { sum_evidence_plain(sums); }

#else

using Bytes = hn::CappedTag<std::uint8_t, kTemplateChunk>;
using Shorts = hn::Repartition<std::int16_t, Bytes>;
using Sums = hn::RebindToUnsigned<Shorts>;
using ByteValues = hn::Vec<Bytes>;
using ShortValues = hn::Vec<Shorts>;
constexpr int kBytes = static_cast<int>(hn::MaxLanes(Bytes()));
constexpr int kShorts = kBytes / 2;

void ThinSums(const std::uint16_t* sum, int step, int count, std::uint16_t* out) {
  const Sums d;
  for (int i = 0; i < count; i += kShorts) {
    const std::uint16_t* at = sum + i * step;
    hn::Vec<Sums> first, second, third, fourth;
    if (step == 2) {
      hn::LoadInterleaved2(d, at, first, second);
    } else {
      hn::LoadInterleaved4(d, at, first, second, third, fourth);
    }
    hn::StoreU(first, d, out + i);
  }
}

// Responses about 0.
HWY_INLINE ShortValues Respond(const std::uint16_t* sum, int flank, ShortValues by) {
  const Sums d;
  const Shorts di;
  const auto middle = hn::LoadU(d, sum);
  const auto beside = hn::Add(hn::LoadU(d, sum + flank), hn::LoadU(d, sum - flank));
  const auto bend = hn::BitCast(di, hn::Sub(beside, hn::Add(middle, middle)));
  const auto full = hn::Set(di, std::int16_t{kFullResponse});
  return hn::Min(hn::Max(hn::MulFixedPoint15(bend, by), hn::Neg(full)), full);
}

HWY_INLINE void StoreResponses(ShortValues low, ShortValues high, int none, std::uint8_t* out) {
  const Bytes d;
  const auto bytes = hn::ConcatEven(d, hn::BitCast(d, high), hn::BitCast(d, low));
  hn::StoreU(hn::Add(bytes, hn::Set(d, static_cast<std::uint8_t>(none))), d, out);
}

void EdgeResponses(const std::uint16_t* sum, int flank, std::int16_t factor, int count,
                   std::uint8_t* out) {
  const auto by = hn::Set(Shorts(), factor);
  for (int i = 0; i < count; i += kBytes) {
    StoreResponses(Respond(sum + i, flank, by), Respond(sum + i + kShorts, flank, by), kNoResponse,
                   out + i);
  }
}

void EdgeResponsesAbove(const std::uint16_t* sum, int flank, std::int16_t factor, int count,
                        const ResponsesAbove& out) {
  const Shorts d;
  const auto by = hn::Set(d, factor);
  const auto scaled = [](ShortValues value, int by_parts) {
    return hn::MulFixedPoint15(value, hn::Set(Shorts(), static_cast<std::int16_t>(by_parts)));
  };
  for (int i = 0; i < count; i += kBytes) {
    const auto low = Respond(sum + i, flank, by), high = Respond(sum + i + kShorts, flank, by);
    StoreResponses(scaled(low, kRightSign), scaled(high, kRightSign), kNoResponse,
                   out.right_sign + i);
    for (const int sign : {1, -1}) {
      const auto either = [&](ShortValues v) {
        return hn::Max(scaled(v, sign * kEitherSign), scaled(v, -sign * kWrongSign));
      };
      StoreResponses(either(low), either(high), kNoEitherSign, out.either_sign[sign < 0] + i);
    }
  }
}

// The running and the highest sum of a vector of columns.
struct Run {
  hn::Vec<Sums> sum, best, foot;

  HWY_INLINE void Add(hn::Vec<Sums> value, hn::Vec<Sums> against) {
    sum = hn::SaturatedSub(hn::Add(sum, value), against);
  }
  HWY_INLINE void End(hn::Vec<Sums> here) {
    const auto higher = hn::Max(best, sum);  // many processors do not compare unsigned numbers
    foot = hn::IfThenElse(hn::Eq(higher, best), foot, here);
    best = higher;
  }
};

// The same of all columns of a vector of bytes.
struct Runs {
  Run even, odd;

  HWY_INLINE void Add(ByteValues value, hn::Vec<Sums> against) {
    const Sums d;
    const auto pairs = hn::BitCast(d, value);
    even.Add(hn::And(pairs, hn::Set(d, 0xff)), against);
    odd.Add(hn::ShiftRight<8>(pairs), against);
  }
  HWY_INLINE void End(hn::Vec<Sums> here) {
    even.End(here);
    odd.End(here);
  }
  HWY_INLINE void Store(std::int16_t* evidence, std::int16_t* foot) const {
    const Shorts d;
    hn::StoreInterleaved2(hn::BitCast(d, even.best), hn::BitCast(d, odd.best), d, evidence);
    hn::StoreInterleaved2(hn::BitCast(d, even.foot), hn::BitCast(d, odd.foot), d, foot);
  }
};

HWY_INLINE ByteValues Joined(ByteValues l, ByteValues r) {
  return hn::AverageRound(hn::AverageRound(l, r), hn::Min(l, r));
}

// Of falling brightness instead of rising.
HWY_INLINE ByteValues Turned(ByteValues response) { return hn::Sub(hn::Zero(Bytes()), response); }

void SumEvidence(const EvidenceSums& s) {
  const Bytes d;
  const auto zero = hn::Zero(Sums());
  const Run none{zero, zero, zero};
  const auto against_above = hn::Set(Sums(), kAgainstAbove), against = hn::Set(Sums(), kAgainst);
  for (int start = 0; start < s.count; start += kBytes) {
    Runs dark{none, none}, bright{none, none};
    const auto end = [&](int band) {
      if (band + 1 < s.first_foot) return;
      const auto here = hn::Set(Sums(), static_cast<std::uint16_t>(band + 1));
      dark.End(here);
      bright.End(here);
    };
    std::ptrdiff_t at = start;
    int band = 0;
    for (; band < std::min(s.horizon, s.last_foot); ++band, at += s.pitch) {
      const auto left = hn::LoadU(d, s.responses + at);
      const auto right = hn::LoadU(d, s.responses + at + s.across);
      const std::uint8_t *rising = s.either_sign[0] + at, *falling = s.either_sign[1] + at;
      dark.Add(hn::Max(Joined(Turned(left), right),
                       Joined(hn::LoadU(d, falling), hn::LoadU(d, rising + s.across))),
               against_above);
      bright.Add(hn::Max(Joined(left, Turned(right)),
                         Joined(hn::LoadU(d, rising), hn::LoadU(d, falling + s.across))),
                 against_above);
      end(band);
    }
    for (; band < s.last_foot; ++band, at += s.pitch) {
      const auto left = hn::LoadU(d, s.responses + at);
      const auto right = hn::LoadU(d, s.responses + at + s.across);
      dark.Add(Joined(Turned(left), right), against);
      bright.Add(Joined(left, Turned(right)), against);
      end(band);
    }
    dark.Store(s.evidence[0] + start, s.foot[0] + start);
    bright.Store(s.evidence[1] + start, s.foot[1] + start);
  }
}

#endif  // HWY_TARGET

int FindPeaks(const std::int16_t* evidence, int count, int least, int reach, int* places) {
  const hn::CappedTag<std::int16_t, kTemplateChunk> d;
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

HWY_EXPORT(ThinSums);
HWY_EXPORT(EdgeResponses);
HWY_EXPORT(EdgeResponsesAbove);
HWY_EXPORT(SumEvidence);
HWY_EXPORT(FindPeaks);

void thin_sums(const std::uint16_t* sum, int step, int count, std::uint16_t* out) {
  HWY_DYNAMIC_DISPATCH(ThinSums)(sum, step, count, out);
}

void edge_responses(const std::uint16_t* sum, int flank, std::int16_t factor, int count,
                    std::uint8_t* out) {
  HWY_DYNAMIC_DISPATCH(EdgeResponses)(sum, flank, factor, count, out);
}

void edge_responses_above(const std::uint16_t* sum, int flank, std::int16_t factor, int count,
                          const ResponsesAbove& out) {
  HWY_DYNAMIC_DISPATCH(EdgeResponsesAbove)(sum, flank, factor, count, out);
}

void sum_evidence(const EvidenceSums& sums) { HWY_DYNAMIC_DISPATCH(SumEvidence)(sums); }

void thin_sums_plain(const std::uint16_t* sum, int step, int count, std::uint16_t* out) {
  for (int i = 0; i < count; ++i) out[i] = sum[i * step];
}

namespace {

// About 0.
int respond(const std::uint16_t* sum, int flank, int factor) {
  const auto bend = static_cast<std::int16_t>(sum[flank] - 2 * sum[0] + sum[-flank]);
  return std::clamp(times_fixed_point15(bend, factor), -kFullResponse, kFullResponse);
}

}  // namespace

void edge_responses_plain(const std::uint16_t* sum, int flank, std::int16_t factor, int count,
                          std::uint8_t* out) {
  for (int i = 0; i < count; ++i)
    out[i] = static_cast<std::uint8_t>(kNoResponse + respond(sum + i, flank, factor));
}

void edge_responses_above_plain(const std::uint16_t* sum, int flank, std::int16_t factor, int count,
                                const ResponsesAbove& out) {
  for (int i = 0; i < count; ++i) {
    const int value = respond(sum + i, flank, factor);
    out.right_sign[i] =
        static_cast<std::uint8_t>(kNoResponse + times_fixed_point15(value, kRightSign));
    for (const int sign : {1, -1}) {
      const int either = std::max(times_fixed_point15(value, sign * kEitherSign),
                                  times_fixed_point15(value, -sign * kWrongSign));
      out.either_sign[sign < 0][i] = static_cast<std::uint8_t>(kNoEitherSign + either);
    }
  }
}

void sum_evidence_plain(const EvidenceSums& s) {
  const auto joined = [](int l, int r) { return (((l + r + 1) >> 1) + std::min(l, r) + 1) >> 1; };
  const auto turned = [](int response) { return 2 * kNoResponse - response; };
  for (int i = 0; i < s.count; ++i) {
    for (const int polarity : {0, 1}) {
      int sum = 0, best = 0, foot = 0;
      for (int band = 0; band < s.last_foot; ++band) {
        const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(band) * s.pitch + i;
        const int left = s.responses[at], right = s.responses[at + s.across];
        int value = polarity == 0 ? joined(turned(left), right) : joined(left, turned(right));
        if (band < s.horizon) {
          value = std::max(value, joined(s.either_sign[1 - polarity][at],
                                         s.either_sign[polarity][at + s.across]));
        }
        sum = std::max(0, sum + value - (band < s.horizon ? kAgainstAbove : kAgainst));
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
