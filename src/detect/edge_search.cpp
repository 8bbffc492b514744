#include "detect/edge_search.h"

#include <algorithm>
#include <cstdlib>

// Vectors of scalable length are left out: they cannot stand in arrays.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detect/edge_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef BOLE_DETECT_EDGE_SEARCH_ONCE
#define BOLE_DETECT_EDGE_SEARCH_ONCE
namespace bole {
namespace {

using Search = EdgeSearch;

// What is added before a truncation, so that it rounds to the nearest whole number.
constexpr float kFar = 16384;
constexpr int kMiddle = (Search::kColumns - Search::kPlaces) / 2;

struct SearchBuffers {
  alignas(64) std::int16_t responses[kMostEdgeBands][Search::kColumns];
  alignas(64) std::int32_t starts[kMostEdgeBands];  // where in the window a slope's places start
  alignas(64) std::int16_t totals[Search::kSlopes][Search::kPlaces];
};

// bend / flank for 0 <= bend < 2^12 is bend times this, divided by 2^16.
std::uint16_t reciprocal(int flank) { return static_cast<std::uint16_t>(65536 / flank + 1); }

float slope_of(const Search& search, int s) {
  return search.slope_step * static_cast<float>(s - Search::kSlopes / 2);
}

float share_of(int place) {
  return 1 - 0.03F * static_cast<float>(std::abs(place - Search::kPlaces / 2));
}

}  // namespace
}  // namespace bole
#endif

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE void Respond(const EdgeBands& bands, const Search& search, SearchBuffers& buffers) {
  const hn::CappedTag<std::uint16_t, Search::kPlaces> d;
  const hn::RebindToSigned<decltype(d)> di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto most = hn::Set(d, static_cast<std::uint16_t>(search.limit * bands.flank));
  const auto share = hn::Set(d, reciprocal(bands.flank));
  const auto sign = hn::Set(di, static_cast<std::int16_t>(search.sign < 0 ? -1 : 0));
  for (int band = 0; band < bands.count; ++band) {
    const std::uint16_t* sums = bands.sums + band * bands.pitch + search.first_column;
    for (int i = 0; i < Search::kColumns; i += lanes) {
      const auto middle = hn::LoadU(d, sums + i);
      const auto bend =
          hn::BitCast(di, hn::Sub(hn::Sub(hn::LoadU(d, sums + i + bands.flank), middle),
                                  hn::Sub(middle, hn::LoadU(d, sums + i - bands.flank))));
      const auto size = hn::MulHigh(hn::Min(hn::BitCast(d, hn::Abs(bend)), most), share);
      const auto negative = hn::Xor(hn::ShiftRight<15>(bend), sign);
      auto value = hn::Sub(hn::Xor(hn::BitCast(di, size), negative), negative);
      if (band < bands.horizon)
        value = hn::Max(value, hn::ShiftRight<4>(hn::Mul(value, hn::Set(di, -11))));
      hn::Store(value, di, buffers.responses[band] + i);
    }
  }
}

HWY_INLINE void Start(const EdgeBands& bands, float slope, SearchBuffers& buffers) {
  const hn::CappedTag<std::int32_t, kEdgeLanes> d;
  const hn::RebindToFloat<decltype(d)> df;
  const auto step = hn::Set(df, bands.row_step), first = hn::Set(df, bands.first_row);
  for (int band = 0; band < bands.count; band += static_cast<int>(hn::Lanes(d))) {
    const auto row = hn::Add(first, hn::Mul(step, hn::Iota(df, static_cast<float>(band))));
    const auto shift = hn::Add(hn::Mul(row, hn::Set(df, slope)), hn::Set(df, kFar + 0.5F));
    const auto start =
        hn::Sub(hn::ConvertTo(d, shift), hn::Set(d, static_cast<std::int32_t>(kFar) - kMiddle));
    hn::Store(hn::Min(hn::Max(start, hn::Zero(d)), hn::Set(d, 2 * kMiddle)), d,
              buffers.starts + band);
  }
}

HWY_INLINE void SumSlope(const EdgeBands& bands, const SearchBuffers& buffers,
                         std::int16_t* totals) {
  const hn::CappedTag<std::int16_t, Search::kPlaces> d;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(d)), kParts = Search::kPlaces / kLanes;
  hn::Vec<decltype(d)> sums[kParts];
  for (auto& sum : sums) sum = hn::Zero(d);
  for (int band = 0; band < bands.count; ++band) {
    const std::int16_t* from = buffers.responses[band] + buffers.starts[band];
    for (int p = 0; p < kParts; ++p) sums[p] = hn::Add(sums[p], hn::LoadU(d, from + p * kLanes));
  }
  for (int p = 0; p < kParts; ++p) hn::Store(sums[p], d, totals + p * kLanes);
}

HWY_INLINE FoundEdge Highest(const Search& search, const SearchBuffers& buffers) {
  const hn::CappedTag<float, kEdgeLanes> d;
  const hn::RebindToSigned<decltype(d)> di;
  const hn::Rebind<std::int16_t, decltype(d)> d16;
  alignas(64) float shares[Search::kPlaces], values[Search::kPlaces];
  alignas(64) std::int32_t slopes[Search::kPlaces];
  for (int i = 0; i < Search::kPlaces; ++i) shares[i] = share_of(i);
  for (int i = 0; i < Search::kPlaces; i += static_cast<int>(hn::Lanes(d))) {
    auto best = hn::Set(d, -1e9F);
    auto slope = hn::Zero(di);
    for (int s = 0; s < Search::kSlopes; ++s) {
      const auto total = hn::ConvertTo(d, hn::PromoteTo(di, hn::Load(d16, buffers.totals[s] + i)));
      const auto value = hn::Mul(total, hn::Load(d, shares + i));
      slope = hn::IfThenElse(hn::RebindMask(di, hn::Gt(value, best)), hn::Set(di, s), slope);
      best = hn::Max(best, value);
    }
    hn::Store(best, d, values + i);
    hn::Store(slope, di, slopes + i);
  }
  constexpr int kCentre = Search::kPlaces / 2;
  FoundEdge found{slopes[kCentre - search.reach], kCentre - search.reach};
  for (int i = kCentre - search.reach; i <= std::min(kCentre + search.reach, Search::kPlaces - 1);
       ++i) {
    const float higher = values[i] - values[found.place];
    if (higher > 0 || (higher == 0 && slopes[i] < found.slope)) found = {slopes[i], i};
  }
  return found;
}

FoundEdge FindEdge(const EdgeBands& bands, const Search& search) {
  SearchBuffers buffers;
  Respond(bands, search, buffers);
  for (int s = 0; s < Search::kSlopes; ++s) {
    Start(bands, slope_of(search, s), buffers);
    SumSlope(bands, buffers, buffers.totals[s]);
  }
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
    const std::uint16_t* at = bands.sums + band * bands.pitch + search.first_column + i;
    const auto bend = static_cast<std::int16_t>(at[bands.flank] - 2 * at[0] + at[-bands.flank]);
    const int value = search.sign * std::clamp(bend / bands.flank, -search.limit, search.limit);
    return band < bands.horizon ? std::max(value, (-11 * value) >> 4) : value;
  };
  float highest = -1e9F;
  FoundEdge found;
  constexpr int kCentre = Search::kPlaces / 2;
  for (int s = 0; s < Search::kSlopes; ++s) {
    for (int i = kCentre - search.reach; i <= std::min(kCentre + search.reach, Search::kPlaces - 1);
         ++i) {
      int total = 0;
      for (int band = 0; band < bands.count; ++band) {
        const float row = bands.first_row + bands.row_step * static_cast<float>(band);
        const int shift =
            static_cast<int>(row * slope_of(search, s) + (kFar + 0.5F)) - static_cast<int>(kFar);
        total += response(band, std::clamp(kMiddle + shift, 0, 2 * kMiddle) + i);
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
