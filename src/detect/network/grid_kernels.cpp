#include "detect/network/grid_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "detect/contrast/bands.h"
#include "detect/rounding.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detect/network/grid_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef BOLE_DETECT_GRID_KERNELS_ONCE
#define BOLE_DETECT_GRID_KERNELS_ONCE
namespace bole {
namespace {

constexpr int kBorders = kGridAcross + 1;

// The sum to a column, not modulo 2^16.
std::int32_t whole_sum(const std::int32_t* coarse, std::uint16_t sum, int column) {
  const std::int32_t before = coarse[column / Bands::kCoarse];
  return before + static_cast<std::uint16_t>(sum - before);
}

// What is read of each band, by border.
struct GridBuffers {
  alignas(64) std::int32_t columns[kMostGridBands][kGridLanes];
  alignas(64) std::int32_t pairs[kMostGridBands][kGridLanes];   // sums at the column and the next
  alignas(64) std::int32_t before[kMostGridBands][kGridLanes];  // the whole sums before
  alignas(64) std::int32_t to_border[kMostGridBands + 1][kGridLanes];  // kCellParts times the sum
  alignas(
      64) std::int32_t cells[kMostGridBands + 1][kGridLanes];  // kCellParts times, of bands before
};

GridStatistics statistics(const float (&totals)[kGridLanes], const float (&squares)[kGridLanes]) {
  float total = 0, square = 0;
  for (int i = 0; i < kGridAcross; ++i) {
    total += totals[i];
    square += squares[i];
  }
  constexpr float kCells = kGridHeights * kGridAcross;
  const float mean = total / kCells;
  return {mean, std::sqrt(std::max(0.0F, square / kCells - mean * mean))};
}

}  // namespace
}  // namespace bole
#endif

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Ints = hn::CappedTag<std::int32_t, kGridLanes>;
using Floats = hn::RebindToFloat<Ints>;

HWY_INLINE hn::Vec<Floats> Borders(const CellColumns& columns, int band, int i) {
  const Floats d;
  const auto middle = hn::Set(d, columns.middle + columns.lean * static_cast<float>(band));
  return hn::Add(middle, hn::Load(d, columns.borders.data() + i));
}

HWY_INLINE void FindColumns(const CellColumns& columns, GridBuffers& buffers) {
  const Floats d;
  const Ints di;
  for (int band = 0; band < columns.bands; ++band) {
    for (int i = 0; i < kGridLanes; i += static_cast<int>(hn::Lanes(d))) {
      const auto far = hn::ConvertTo(di, hn::Add(Borders(columns, band, i), hn::Set(d, kFar)));
      hn::Store(hn::Sub(far, hn::Set(di, static_cast<std::int32_t>(kFar))), di,
                buffers.columns[band] + i);
    }
  }
}

// 64 sums can be looked up at once, which Highway does not offer.
#if HWY_TARGET <= HWY_AVX3

// The sums at each column and the next, out of the 32 kRegisters from the first border's column on.
template <int kRegisters>
HWY_INLINE void PickPairs(const CellColumns& columns, GridBuffers& buffers) {
  const std::uint16_t* sums = columns.sums;
  for (int band = 0; band < columns.bands; ++band, sums += columns.pitch) {
    const std::int32_t first = buffers.columns[band][0];
    __m512i all[kRegisters];
    for (int k = 0; k < kRegisters; ++k) all[k] = _mm512_loadu_si512(sums + first + 32 * k);
    const __m512i place =
        _mm512_sub_epi32(_mm512_load_si512(buffers.columns[band]), _mm512_set1_epi32(first));
    const __m512i places = _mm512_add_epi32(_mm512_or_si512(place, _mm512_slli_epi32(place, 16)),
                                            _mm512_set1_epi32(1 << 16));
    __m512i pairs = _mm512_permutex2var_epi16(all[0], places, all[1]);
    if constexpr (kRegisters == 4) {
      const __mmask32 beyond = _mm512_movepi16_mask(_mm512_slli_epi16(places, 9));  // 64 and more
      pairs =
          _mm512_mask_blend_epi16(beyond, pairs, _mm512_permutex2var_epi16(all[2], places, all[3]));
    }
    _mm512_store_si512(buffers.pairs[band], pairs);
  }
}

// False where the borders lie too far apart.
HWY_INLINE bool PickPairs(const CellColumns& columns, GridBuffers& buffers) {
  static_assert(kGridLookahead == 128);
  const float across = columns.borders[kGridAcross] - columns.borders[0];
  if (across < 62) {
    PickPairs<2>(columns, buffers);
  } else if (across < 126) {
    PickPairs<4>(columns, buffers);
  } else {
    return false;
  }
  return true;
}

#else

HWY_INLINE bool PickPairs(const CellColumns&, GridBuffers&) { return false; }

#endif

// One by one: gather instructions take longer.
HWY_INLINE void GatherPairs(const CellColumns& columns, GridBuffers& buffers) {
  const std::uint16_t* sums = columns.sums;
  for (int band = 0; band < columns.bands; ++band, sums += columns.pitch) {
    for (int i = 0; i < kBorders; ++i)
      std::memcpy(&buffers.pairs[band][i], sums + buffers.columns[band][i], sizeof(std::int32_t));
  }
}

HWY_INLINE void Gather(const CellColumns& columns, GridBuffers& buffers) {
  if (!PickPairs(columns, buffers)) GatherPairs(columns, buffers);
  if (!columns.coarse) return;
  const std::int32_t* coarse = columns.coarse;
  for (int band = 0; band < columns.bands; ++band, coarse += columns.coarse_pitch) {
    for (int i = 0; i < kBorders; ++i) {
      buffers.before[band][i] =
          coarse[(buffers.columns[band][i] + columns.margin) / Bands::kCoarse];
    }
  }
}

// kCellParts times the sum to each border; modulo 2^20 where only the sums modulo 2^16 are known.
HWY_INLINE void SumToBorders(const CellColumns& columns, GridBuffers& buffers) {
  const Floats d;
  const Ints di;
  const auto low = hn::Set(di, 0xffff);
  const auto half = hn::Set(d, 0.5F), parts = hn::Set(d, float{kCellParts});
  for (int band = 0; band < columns.bands; ++band) {
    for (int i = 0; i < kGridLanes; i += static_cast<int>(hn::Lanes(d))) {
      const auto pair = hn::Load(di, buffers.pairs[band] + i);
      auto sum = hn::And(pair, low);
      const auto level = hn::And(hn::Sub(hn::ShiftRight<16>(pair), sum), low);
      if (columns.coarse) {
        const auto before = hn::Load(di, buffers.before[band] + i);
        sum = hn::Add(before, hn::And(hn::Sub(sum, before), low));
      }
      const auto column = hn::ConvertTo(d, hn::Load(di, buffers.columns[band] + i));
      const auto rest = hn::Mul(hn::Sub(Borders(columns, band, i), column),
                                hn::Mul(hn::ConvertTo(d, level), parts));
      hn::Store(hn::Add(hn::ShiftLeft<4>(sum), hn::ConvertTo(di, hn::Add(rest, half))), di,
                buffers.to_border[band] + i);
    }
  }
}

HWY_INLINE void SumBands(const CellColumns& columns, GridBuffers& buffers) {
  const Ints di;
  buffers.to_border[columns.bands][0] = 0;  // read beside the last cell
  const auto known = hn::Set(di, columns.coarse ? -1 : 0xfffff);
  for (int i = 0; i < kGridLanes; i += static_cast<int>(hn::Lanes(di))) {
    auto total = hn::Zero(di);
    hn::Store(total, di, buffers.cells[0] + i);
    for (int band = 0; band < columns.bands; ++band) {
      const std::int32_t* at = buffers.to_border[band] + i;
      const auto cell = hn::And(hn::Sub(hn::LoadU(di, at + 1), hn::Load(di, at)), known);
      total = hn::Add(total, cell);
      hn::Store(total, di, buffers.cells[band + 1] + i);
    }
  }
}

GridStatistics ReadCells(const CellColumns& columns, const std::array<CellRows, kGridHeights>& rows,
                         GridValues& values) {
  static_assert(kCellParts == 1 << 4);
  const Floats d;
  const Ints di;
  GridBuffers buffers;
  FindColumns(columns, buffers);
  Gather(columns, buffers);
  SumToBorders(columns, buffers);
  SumBands(columns, buffers);
  alignas(64) float totals[kGridLanes], squares[kGridLanes];
  for (int i = 0; i < kGridLanes; i += static_cast<int>(hn::Lanes(d))) {
    auto total = hn::Zero(d), square = hn::Zero(d);
    const auto across = hn::Load(d, columns.factors.data() + i);
    const auto at = [&](int band) { return hn::Load(di, buffers.cells[band] + i); };
    for (int h = 0; h < kGridHeights; ++h) {
      const CellRows& r = rows[h];
      const auto beyond = [&](int band, float rest) {
        return hn::Mul(hn::Set(d, rest), hn::ConvertTo(d, hn::Sub(at(band + 1), at(band))));
      };
      const auto whole = hn::ConvertTo(d, hn::Sub(at(r.to), at(r.from)));
      const auto sum =
          hn::Sub(hn::Add(whole, beyond(r.to, r.to_rest)), beyond(r.from, r.from_rest));
      const auto value = hn::Mul(hn::Mul(sum, hn::Set(d, r.factor)), across);
      hn::StoreU(value, d, values[h].data() + i);
      total = hn::Add(total, value);
      square = hn::Add(square, hn::Mul(value, value));
    }
    hn::Store(total, d, totals + i);
    hn::Store(square, d, squares + i);
  }
  return statistics(totals, squares);
}

}  // namespace bole::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bole {

HWY_EXPORT(ReadCells);

GridStatistics read_cells(const CellColumns& columns,
                          const std::array<CellRows, kGridHeights>& rows, GridValues& values) {
  return HWY_DYNAMIC_DISPATCH(ReadCells)(columns, rows, values);
}

GridStatistics read_cells_plain(const CellColumns& columns,
                                const std::array<CellRows, kGridHeights>& rows,
                                GridValues& values) {
  const auto to_border = [&](int band, int i) {
    const std::uint16_t* at = columns.sums + band * columns.pitch;
    const float x = columns.middle + columns.lean * static_cast<float>(band) + columns.borders[i];
    const int column = static_cast<int>(x + kFar) - static_cast<int>(kFar);
    const auto level = static_cast<std::uint16_t>(at[column + 1] - at[column]);
    const float rest =
        (x - static_cast<float>(column)) * (static_cast<float>(level) * float{kCellParts});
    const int whole = columns.coarse ? whole_sum(columns.coarse + band * columns.coarse_pitch,
                                                 at[column], column + columns.margin)
                                     : at[column];
    // The rest is not negative, and std::lround would be a call.
    // NOLINTNEXTLINE(bugprone-incorrect-roundings)
    return kCellParts * whole + static_cast<int>(rest + 0.5F);
  };
  const auto cell = [&](int band, int i) {
    const int sum = to_border(band, i + 1) - to_border(band, i);
    return columns.coarse ? sum : sum & (65536 * kCellParts - 1);
  };
  float totals[kGridLanes] = {}, squares[kGridLanes] = {};
  for (int h = 0; h < kGridHeights; ++h) {
    const CellRows& r = rows[h];
    for (int i = 0; i < kGridAcross; ++i) {
      int whole = 0;
      for (int band = r.from; band < r.to; ++band) whole += cell(band, i);
      const float sum = static_cast<float>(whole) + r.to_rest * static_cast<float>(cell(r.to, i)) -
                        r.from_rest * static_cast<float>(cell(r.from, i));
      const float value = sum * r.factor * columns.factors[i];
      values[h][i] = value;
      totals[i] += value;
      squares[i] += value * value;
    }
  }
  return statistics(totals, squares);
}

}  // namespace bole
#endif  // HWY_ONCE
