#include "detect/contrast/edge_kernels.h"

#include <algorithm>
#include <cstdlib>

#include "detect/rounding.h"

// Vectors of scalable length are left out: they cannot stand in arrays.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detect/contrast/edge_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef BOLE_DETECT_EDGE_KERNELS_ONCE
#define BOLE_DETECT_EDGE_KERNELS_ONCE
namespace bole {
namespace {

// Columns nearest to a line, band by band.
struct NearestColumns {
  alignas(64) std::int32_t at[kMostEdgeBands];
};

// Bands at a time, at most.
constexpr int kPeakLanes = 32;

// Peaks of the bands' responses about a line.
struct Peaks {
  static constexpr int kBands = (kMostEdgeBands + kPeakLanes - 1) / kPeakLanes * kPeakLanes;
  alignas(64) std::int16_t height[kBands];  // 0: none
  alignas(64) std::int16_t place[kBands];   // columns from the first one looked at
  alignas(64) std::int16_t fall[kBands];    // of the response, from before to after it
  alignas(64) std::int16_t bend[kBands];    // of the response at it
};

}  // namespace
}  // namespace bole
#endif

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR  // a processor without vectors

void PlaceEdge(const EdgeBands& bands, EdgeLine line, int sign, int least, float strongest,
               EdgePlaces& places) {
  place_edge_plain(bands, line, sign, least, strongest, places);
}

LineSums SumPlaces(const EdgePlaces& places, EdgeLine line, float tail) {
  return sum_places_plain(places, line, tail);
}

EdgeResponses RespondAlong(const EdgeBands& bands, EdgeLine left, EdgeLine right, float full) {
  return respond_along_plain(bands, left, right, full);
}

void JoinEdges(const EdgeBands& bands, EdgeLine left, EdgeLine right, float full,
               BandValues& values) {
  join_edges_plain(bands, left, right, full, values);
}

#else

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kEdgeLanes>;
using Ints = hn::RebindToSigned<Floats>;
using Shorts = hn::Rebind<std::int16_t, Floats>;
using Vector = hn::Vec<Floats>;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(Floats()));
constexpr int kParts = kEdgeLanes / kLanes;

using Four = hn::FixedTag<float, 4>;
using FourValues = hn::Vec<Four>;

// The sum of a vector's parts of four lanes, in halves.
template <class D>
HWY_INLINE FourValues Folded(D d, hn::Vec<D> values) {
  if constexpr (hn::MaxLanes(d) == 4) {
    return values;
  } else {
    const hn::Half<D> half;
    return Folded(half, hn::Add(hn::LowerHalf(half, values), hn::UpperHalf(half, values)));
  }
}

// kEdgeLanes sums side by side, in as many vectors as it takes.
struct Sum {
  Vector parts[kParts];
  HWY_INLINE Sum() {
    for (Vector& part : parts) part = hn::Zero(Floats());
  }
  HWY_INLINE void Add(int part, Vector value) { parts[part] = hn::Add(parts[part], value); }

  HWY_INLINE FourValues Fold() const {
    Vector sums[kParts];
    for (int p = 0; p < kParts; ++p) sums[p] = parts[p];
    for (int half = kParts / 2; half > 0; half /= 2)
      for (int p = 0; p < half; ++p) sums[p] = hn::Add(sums[p], sums[p + half]);
    return Folded(Floats(), sums[0]);
  }
};

// The totals of four sums.
HWY_INLINE FourValues Totals(const Sum& a, const Sum& b, const Sum& c, const Sum& d) {
  const Four four;
  const auto halves = [&](FourValues x, FourValues y) {
    return hn::Add(hn::InterleaveLower(four, x, y), hn::InterleaveUpper(four, x, y));
  };
  const FourValues ab = halves(a.Fold(), b.Fold()), cd = halves(c.Fold(), d.Fold());
  return hn::Add(hn::ConcatLowerLower(four, cd, ab), hn::ConcatUpperUpper(four, cd, ab));
}

HWY_INLINE Vector Rows(const EdgeBands& bands, int band) {
  const Floats d;
  return hn::Add(hn::Set(d, bands.first_row),
                 hn::Mul(hn::Set(d, bands.row_step), hn::Iota(d, static_cast<float>(band))));
}

HWY_INLINE Vector LoadShorts(const std::int16_t* from) {
  return hn::ConvertTo(Floats(), hn::PromoteTo(Ints(), hn::Load(Shorts(), from)));
}

HWY_INLINE void Follow(const EdgeBands& bands, EdgeLine line, NearestColumns& columns) {
  const Floats d;
  for (int band = 0; band < bands.count; band += kLanes) {
    const auto column = hn::Add(hn::Mul(Rows(bands, band), hn::Set(d, line.slope)),
                                hn::Set(d, line.column + (kFar + 0.5F)));
    hn::Store(
        hn::Sub(hn::ConvertTo(Ints(), column), hn::Set(Ints(), static_cast<std::int32_t>(kFar))),
        Ints(), columns.at + band);
  }
}

using Eight = hn::FixedTag<std::int16_t, 8>;
using Many = hn::CappedTag<std::int16_t, kPeakLanes>;
using ManyValues = hn::Vec<Many>;
constexpr int kBlocks = static_cast<int>(hn::MaxLanes(Many())) / 8;

// In every block of eight lanes, rows become columns: three times every row is interleaved with the
// one four after it.
HWY_INLINE void Transpose(ManyValues (&rows)[8]) {
  const Many d;
  for (int round = 0; round < 3; ++round) {
    ManyValues mixed[8];
    for (int i = 0; i < 4; ++i) {
      mixed[2 * i] = hn::InterleaveLower(d, rows[i], rows[i + 4]);
      mixed[2 * i + 1] = hn::InterleaveUpper(d, rows[i], rows[i + 4]);
    }
    for (int i = 0; i < 8; ++i) rows[i] = mixed[i];
  }
}

// The peaks of a vector of bands, from responses at eight columns (the last one is not looked at).
HWY_INLINE void FindPeaks(const ManyValues (&responses)[8], int least, int first, Peaks& peaks) {
  const Many d;
  constexpr int kLast = 2 * EdgePlaces::kReach;
  auto height = responses[0], place = hn::Zero(d), before = hn::Zero(d), after = hn::Zero(d);
  for (int o = 1; o <= kLast; ++o) {
    const auto higher = hn::Gt(responses[o], height);
    height = hn::Max(height, responses[o]);
    place = hn::IfThenElse(higher, hn::Set(d, static_cast<std::int16_t>(o)), place);
    before = hn::IfThenElse(higher, responses[o - 1], before);
    after = hn::IfThenElse(higher, responses[o + 1], after);
  }
  const auto inside =
      hn::And(hn::Gt(place, hn::Zero(d)), hn::Lt(place, hn::Set(d, std::int16_t{kLast})));
  const auto good =
      hn::And(inside, hn::Gt(height, hn::Set(d, static_cast<std::int16_t>(least - 1))));
  hn::Store(hn::IfThenElseZero(good, height), d, peaks.height + first);
  hn::Store(place, d, peaks.place + first);
  hn::Store(hn::Sub(before, after), d, peaks.fall + first);
  hn::Store(hn::Sub(hn::Add(before, after), hn::Add(height, height)), d, peaks.bend + first);
}

void LookAlong(const EdgeBands& bands, const NearestColumns& columns, int sign, int least,
               Peaks& peaks) {
  const Eight d;
  const hn::RebindToUnsigned<Eight> du;
  const auto flip = hn::Set(d, static_cast<std::int16_t>(sign < 0 ? -1 : 0));
  for (int first = 0; first < bands.count; first += 8 * kBlocks) {
    // Eight bands stand in rows of their own, the next eight beside them.
    alignas(64) std::int16_t beside[8][8 * kBlocks];
    for (int k = 0; k < 8 * kBlocks; ++k) {
      const int band = std::min(first + k, bands.count - 1);
      const std::uint16_t* at =
          bands.sums + band * bands.pitch + columns.at[band] - EdgePlaces::kReach;
      const auto middle = hn::LoadU(du, at);
      const auto bend = hn::BitCast(d, hn::Sub(hn::Sub(hn::LoadU(du, at + bands.flank), middle),
                                               hn::Sub(middle, hn::LoadU(du, at - bands.flank))));
      const auto response =
          band < bands.horizon ? hn::Abs(bend) : hn::Sub(hn::Xor(bend, flip), flip);
      hn::Store(response, d, beside[k % 8] + k / 8 * 8);
    }
    ManyValues responses[8];
    for (int k = 0; k < 8; ++k) responses[k] = hn::Load(Many(), beside[k]);
    Transpose(responses);
    FindPeaks(responses, least, first, peaks);
  }
  for (int band = bands.count; band < EdgePlaces::whole_groups(bands.count); ++band)
    peaks.height[band] = 0;
}

void PlaceEdge(const EdgeBands& bands, EdgeLine line, int sign, int least, float strongest,
               EdgePlaces& places) {
  const Floats d;
  NearestColumns columns;
  Follow(bands, line, columns);
  Peaks peaks;
  LookAlong(bands, columns, sign, least, peaks);
  const auto share = hn::Set(d, 1 / static_cast<float>(bands.flank));
  const auto half = hn::Set(d, 0.5F);
  places.count = EdgePlaces::whole_groups(bands.count);
  places.found = 0;
  for (int band = 0; band < bands.count; band += kLanes) {
    const auto height = LoadShorts(peaks.height + band), bend = LoadShorts(peaks.bend + band);
    const auto there = hn::Gt(height, hn::Zero(d));
    const auto shift = hn::Div(hn::Mul(half, LoadShorts(peaks.fall + band)), bend);
    const auto bound = hn::Min(half, hn::Max(hn::Neg(half), shift));
    const auto fine = hn::IfThenElseZero(hn::Lt(bend, hn::Zero(d)), bound);
    const auto whole =
        hn::Add(hn::ConvertTo(d, hn::Load(Ints(), columns.at + band)),
                hn::Sub(LoadShorts(peaks.place + band), hn::Set(d, float{EdgePlaces::kReach})));
    hn::Store(Rows(bands, band), d, places.row.data() + band);
    hn::Store(hn::IfThenElseZero(there, hn::Add(whole, fine)), d, places.column.data() + band);
    hn::Store(hn::Min(hn::Mul(height, share), hn::Set(d, strongest)), d,
              places.weight.data() + band);
    places.found += static_cast<int>(hn::CountTrue(d, there));
  }
  for (int band = (bands.count + kLanes - 1) / kLanes * kLanes; band < places.count; ++band)
    places.row[band] = places.column[band] = places.weight[band] = 0;
}

LineSums SumPlaces(const EdgePlaces& places, EdgeLine line, float tail) {
  const Floats d;
  const auto one = hn::Set(d, 1.0F), shrink = hn::Set(d, 1 / tail);
  Sum w, row, row_row, error, row_error, error_error;
  for (int i = 0; i < places.count; i += kEdgeLanes) {
    for (int p = 0; p < kParts; ++p) {
      const int at = i + p * kLanes;
      const auto r = hn::Load(d, places.row.data() + at);
      const auto line_at = hn::Add(hn::Set(d, line.column), hn::Mul(hn::Set(d, line.slope), r));
      const auto e = hn::Sub(hn::Load(d, places.column.data() + at), line_at);
      const auto u = hn::Mul(e, shrink);
      const auto rest = hn::Max(hn::Zero(d), hn::Sub(one, hn::Mul(u, u)));
      const auto weight = hn::Mul(hn::Load(d, places.weight.data() + at), hn::Mul(rest, rest));
      const auto weighted_row = hn::Mul(weight, r), weighted_error = hn::Mul(weight, e);
      w.Add(p, weight);
      row.Add(p, weighted_row);
      row_row.Add(p, hn::Mul(weighted_row, r));
      error.Add(p, weighted_error);
      row_error.Add(p, hn::Mul(weighted_row, e));
      error_error.Add(p, hn::Mul(weighted_error, e));
    }
  }
  alignas(32) float totals[8];
  hn::Store(Totals(w, row, row_row, error), Four(), totals);
  hn::Store(Totals(row_error, error_error, {}, {}), Four(), totals + 4);
  return {totals[0], totals[1], totals[2], totals[3], totals[4], totals[5]};
}

// The bends at the bands along a line; 0 beyond them.
struct BendsAlong {
  alignas(64) std::int16_t at[kMostEdgeBands] = {};
  HWY_INLINE BendsAlong(const EdgeBands& bands, EdgeLine line) {
    NearestColumns columns;
    Follow(bands, line, columns);
    for (int band = 0; band < bands.count; ++band) at[band] = bands.bend(band, columns.at[band]);
  }
  HWY_INLINE Vector Responses(int band, Vector factor) const {
    const auto one = hn::Set(Floats(), 1.0F);
    return hn::Min(one, hn::Max(hn::Neg(one), hn::Mul(LoadShorts(at + band), factor)));
  }
};

HWY_INLINE auto IsAbove(const EdgeBands& bands, int band) {
  const Floats d;
  return hn::Lt(hn::Iota(d, static_cast<float>(band)),
                hn::Set(d, static_cast<float>(bands.horizon)));
}

EdgeResponses RespondAlong(const EdgeBands& bands, EdgeLine left, EdgeLine right, float full) {
  const Floats d;
  const BendsAlong bends[2] = {{bands, left}, {bands, right}};
  const auto share = hn::Set(d, 1 / full);
  Sum below[2], above[2];
  EdgeResponses result;
  for (int i = 0; i < bands.count; i += kEdgeLanes) {
    for (int p = 0; p < kParts; ++p) {
      const int band = i + p * kLanes;
      const Vector l = bends[0].Responses(band, hn::Neg(share));
      const Vector r = bends[1].Responses(band, share);
      const auto is_above = IsAbove(bands, band);
      below[0].Add(p, hn::IfThenZeroElse(is_above, l));
      below[1].Add(p, hn::IfThenZeroElse(is_above, r));
      above[0].Add(p, hn::IfThenElseZero(is_above, hn::Abs(l)));
      above[1].Add(p, hn::IfThenElseZero(is_above, hn::Abs(r)));
      const auto agree = hn::Gt(hn::Min(l, r), hn::Set(d, 0.25F));
      const auto agree_above = hn::Gt(hn::Min(hn::Abs(l), hn::Abs(r)), hn::Set(d, 0.3F));
      result.agree_below += static_cast<int>(hn::CountTrue(d, hn::AndNot(is_above, agree)));
      result.agree_above += static_cast<int>(hn::CountTrue(d, hn::And(is_above, agree_above)));
    }
  }
  alignas(16) float totals[4];
  hn::Store(Totals(below[0], below[1], above[0], above[1]), Four(), totals);
  result.below = {totals[0], totals[1]};
  result.above = {totals[2], totals[3]};
  return result;
}

void JoinEdges(const EdgeBands& bands, EdgeLine left, EdgeLine right, float full,
               BandValues& values) {
  const Floats d;
  const BendsAlong bends[2] = {{bands, left}, {bands, right}};
  const auto share = hn::Set(d, 1 / full), half = hn::Set(d, 0.5F);
  const auto joined = [&](Vector l, Vector r, float against) {
    const auto sum = hn::Mul(hn::Set(d, 0.25F), hn::Add(l, r));
    return hn::Sub(hn::Add(sum, hn::Mul(half, hn::Min(l, r))), hn::Set(d, against));
  };
  const auto any_sign = [&](Vector v) {
    return hn::Max(v, hn::Mul(hn::Set(d, kWrongSignAbove), v));
  };
  for (int band = 0; band < bands.count; band += kLanes) {
    const Vector l = bends[0].Responses(band, hn::Neg(share));
    const Vector r = bends[1].Responses(band, share);
    const auto above = hn::Mul(hn::Set(d, 0.4F), joined(any_sign(l), any_sign(r), 0.5F));
    const auto value = hn::IfThenElse(IsAbove(bands, band), above, joined(l, r, 0.3F));
    hn::StoreU(value, d, values.data() + band);
  }
}

#endif  // HWY_TARGET

}  // namespace bole::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bole {

HWY_EXPORT(PlaceEdge);
HWY_EXPORT(SumPlaces);
HWY_EXPORT(RespondAlong);
HWY_EXPORT(JoinEdges);

void place_edge(const EdgeBands& bands, EdgeLine line, int sign, int least, float strongest,
                EdgePlaces& places) {
  HWY_DYNAMIC_DISPATCH(PlaceEdge)(bands, line, sign, least, strongest, places);
}

LineSums sum_places(const EdgePlaces& places, EdgeLine line, float tail) {
  return HWY_DYNAMIC_DISPATCH(SumPlaces)(places, line, tail);
}

EdgeResponses respond_along(const EdgeBands& bands, EdgeLine left, EdgeLine right, float full) {
  return HWY_DYNAMIC_DISPATCH(RespondAlong)(bands, left, right, full);
}

void join_edges(const EdgeBands& bands, EdgeLine left, EdgeLine right, float full,
                BandValues& values) {
  HWY_DYNAMIC_DISPATCH(JoinEdges)(bands, left, right, full, values);
}

}  // namespace bole
#endif  // HWY_ONCE
