#include "detect/contrast/edge_search.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "detect/contrast/bands.h"
#include "detect/rounding.h"

// Vectors of scalable length are left out: they cannot stand in arrays.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detect/contrast/edge_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef BOLE_DETECT_EDGE_SEARCH_ONCE
#define BOLE_DETECT_EDGE_SEARCH_ONCE
namespace bole {
namespace {

constexpr int kMiddle = (EdgeSearch::kColumns - EdgeSearch::kPlaces) / 2;
constexpr int kUpright = EdgeSearch::kSlopes / 2;

// Columns to a side at which a line, so many slopes from upright, stands in a band: the last one
// above the foot is at distance 1.
constexpr int shift_at(int slopes, int distance) {
  const int thousandths =
      EdgeSearch::kSlopeStep * slopes * (Bands::kRows * distance - Bands::kRows / 2);
  return std::min((thousandths + 500) / 1000, kMiddle);
}

// The least distance at which a line stands so many columns to a side: never, where it is upright.
constexpr auto kDistances = [] {
  std::array<std::array<int, kMiddle + 1>, kUpright + 1> distances{};
  for (int shift = 1; shift <= kMiddle; ++shift) {
    distances[0][shift] = std::numeric_limits<int>::max();
    for (int slopes = 1; slopes <= kUpright; ++slopes) {
      int& distance = distances[slopes][shift];
      while (shift_at(slopes, distance) < shift) ++distance;
    }
  }
  return distances;
}();

// A line stands at the same column in one band after the other, but for few steps: so responses are
// summed down the columns, and a line's sum is taken from step to step.
struct SearchBuffers {
  alignas(64) std::int16_t sums[kMostEdgeBands + 1][EdgeSearch::kColumns];  // of the bands before
  alignas(64) std::int16_t totals[EdgeSearch::kSlopes][EdgeSearch::kPlaces];
};

// What a response of the wrong sign counts above the horizon, in units of 2^-15.
constexpr std::int16_t kWrongSign = -(1 << 15) * 11 / 16;

// sign / flank, in units of 2^-15.
std::int16_t share_of_flank(const EdgeBands& bands, const EdgeSearch& search) {
  const int share = ((1 << 15) + bands.flank / 2) / bands.flank;
  return static_cast<std::int16_t>(search.sign < 0 ? -share : share);
}

constexpr float share_of(int place) {
  const int off = place - EdgeSearch::kPlaces / 2;
  return 1 - 0.03F * static_cast<float>(off < 0 ? -off : off);
}

alignas(64) constexpr auto kShares = [] {
  std::array<float, EdgeSearch::kPlaces> shares{};
  for (int i = 0; i < EdgeSearch::kPlaces; ++i) shares[i] = share_of(i);
  return shares;
}();

}  // namespace
}  // namespace bole
#endif

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Values = hn::CappedTag<std::int16_t, EdgeSearch::kPlaces>;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(Values()));

// Sums the responses of one vector of columns.
HWY_INLINE void SumResponses(const EdgeBands& bands, const EdgeSearch& search, int column,
                             SearchBuffers& buffers) {
  const Values d;
  const hn::RebindToUnsigned<Values> du;
  const auto most = hn::Set(d, static_cast<std::int16_t>(search.limit * bands.flank));
  const auto share = hn::Set(d, share_of_flank(bands, search)), wrong_sign = hn::Set(d, kWrongSign);
  const std::uint16_t* at = bands.sums + search.first_column + column;
  auto sum = hn::Zero(d);
  hn::StoreU(sum, d, buffers.sums[0] + column);
  for (int band = 0; band < bands.count; ++band, at += bands.pitch) {
    const auto middle = hn::LoadU(du, at);
    const auto beside = hn::Add(hn::LoadU(du, at + bands.flank), hn::LoadU(du, at - bands.flank));
    const auto bend = hn::BitCast(d, hn::Sub(beside, hn::Add(middle, middle)));
    auto value = hn::MulFixedPoint15(hn::Min(hn::Max(bend, hn::Neg(most)), most), share);
    if (band < bands.horizon) value = hn::Max(value, hn::MulFixedPoint15(value, wrong_sign));
    sum = hn::Add(sum, value);
    hn::StoreU(sum, d, buffers.sums[band + 1] + column);
  }
}

// The sums along the lines of one slope and its mirror image.
HWY_INLINE void SumSlopes(const EdgeBands& bands, int foot, int slopes, SearchBuffers& buffers) {
  const Values d;
  constexpr int kParts = EdgeSearch::kPlaces / kLanes;
  hn::Vec<Values> right[kParts], left[kParts];
  int shift = shift_at(slopes, foot - bands.count + 1);
  for (int p = 0; p < kParts; ++p) {
    const std::int16_t* all = buffers.sums[bands.count] + kMiddle + p * kLanes;
    right[p] = hn::LoadU(d, all + shift);
    left[p] = hn::LoadU(d, all - shift);
  }
  while (++shift <= kMiddle && kDistances[slopes][shift] <= foot) {
    const std::int16_t* at = buffers.sums[foot - kDistances[slopes][shift] + 1] + kMiddle;
    for (int p = 0; p < kParts; ++p, at += kLanes) {
      const auto step = [&](int to, int from) {
        return hn::Sub(hn::LoadU(d, at + to), hn::LoadU(d, at + from));
      };
      right[p] = hn::Add(right[p], step(shift, shift - 1));
      left[p] = hn::Add(left[p], step(-shift, 1 - shift));
    }
  }
  for (int p = 0; p < kParts; ++p) {
    hn::Store(right[p], d, buffers.totals[kUpright - slopes] + p * kLanes);
    hn::Store(left[p], d, buffers.totals[kUpright + slopes] + p * kLanes);
  }
}

HWY_INLINE FoundEdge Highest(const EdgeSearch& search, const SearchBuffers& buffers) {
  const hn::CappedTag<float, kEdgeLanes> d;
  const hn::RebindToSigned<decltype(d)> di;
  const hn::Rebind<std::int16_t, decltype(d)> d16;
  const int step = static_cast<int>(hn::Lanes(d));
  constexpr int kCentre = EdgeSearch::kPlaces / 2;
  alignas(64) float values[EdgeSearch::kPlaces];
  alignas(64) std::int32_t lines[EdgeSearch::kPlaces];  // first by slope, then by place
  auto highest = hn::Set(d, -1e9F);
  for (int i = 0; i < EdgeSearch::kPlaces; i += step) {
    const auto off = hn::Abs(hn::Sub(hn::Iota(di, i), hn::Set(di, kCentre)));
    const auto outside = hn::RebindMask(d, hn::Gt(off, hn::Set(di, search.reach)));
    auto best = hn::Set(d, -1e9F);
    auto slope = hn::Zero(di);
    for (int s = 0; s < EdgeSearch::kSlopes; ++s) {
      const auto total = hn::ConvertTo(d, hn::PromoteTo(di, hn::Load(d16, buffers.totals[s] + i)));
      const auto value = hn::Mul(total, hn::Load(d, kShares.data() + i));
      slope = hn::IfThenElse(hn::RebindMask(di, hn::Gt(value, best)), hn::Set(di, s), slope);
      best = hn::Max(best, value);
    }
    best = hn::IfThenElse(outside, hn::Set(d, -1e9F), best);
    highest = hn::Max(highest, best);
    hn::Store(best, d, values + i);
    hn::Store(hn::Add(hn::Mul(slope, hn::Set(di, EdgeSearch::kPlaces)), hn::Iota(di, i)), di,
              lines + i);
  }
  highest = hn::MaxOfLanes(d, highest);
  auto first = hn::Set(di, EdgeSearch::kSlopes * EdgeSearch::kPlaces);
  for (int i = 0; i < EdgeSearch::kPlaces; i += step) {
    const auto lower = hn::RebindMask(di, hn::Lt(hn::Load(d, values + i), highest));
    first = hn::Min(first, hn::IfThenElse(lower, first, hn::Load(di, lines + i)));
  }
  const std::int32_t line = hn::GetLane(hn::MinOfLanes(di, first));
  return {line / EdgeSearch::kPlaces, line % EdgeSearch::kPlaces};
}

FoundEdge FindEdge(const EdgeBands& bands, const EdgeSearch& search) {
  SearchBuffers buffers;
  // Narrow trunks that are not tall need half the columns; what else is read does not count.
  const bool near = shift_at(kUpright, search.foot) + search.reach < kMiddle;
  const int first = near ? kMiddle : 0;
  for (int i = first; i < EdgeSearch::kColumns - first; i += kLanes)
    SumResponses(bands, search, i, buffers);
  for (int slopes = 0; slopes <= kUpright; ++slopes) SumSlopes(bands, search.foot, slopes, buffers);
  return Highest(search, buffers);
}

}  // namespace bole::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bole {

HWY_EXPORT(FindEdge);

FoundEdge find_edge(const EdgeBands& bands, const EdgeSearch& search) {
  return HWY_DYNAMIC_DISPATCH(FindEdge)(bands, search);
}

FoundEdge find_edge_plain(const EdgeBands& bands, const EdgeSearch& search) {
  const auto response = [&](int band, int i) {
    const int bend = bands.bend(band, search.first_column + i), most = search.limit * bands.flank;
    const int value =
        times_fixed_point15(std::clamp(bend, -most, most), share_of_flank(bands, search));
    return band < bands.horizon ? std::max(value, times_fixed_point15(value, kWrongSign)) : value;
  };
  float highest = -1e9F;
  FoundEdge found;
  constexpr int kCentre = EdgeSearch::kPlaces / 2;
  for (int s = 0; s < EdgeSearch::kSlopes; ++s) {
    for (int i = kCentre - search.reach;
         i <= std::min(kCentre + search.reach, EdgeSearch::kPlaces - 1); ++i) {
      int total = 0;
      for (int band = 0; band < bands.count; ++band) {
        const int shift = shift_at(std::abs(s - kUpright), search.foot - band);
        total += response(band, kMiddle + (s < kUpright ? shift : -shift) + i);
      }
      const float value = static_cast<float>(total) * share_of(i);
      if (value <= highest) continue;
      highest = value;
      found = {s, i};
    }
  }
  return found;
}

}  // namespace bole
#endif  // HWY_ONCE
