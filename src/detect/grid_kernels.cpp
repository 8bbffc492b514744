#include "detect/grid_kernels.h"

#include <cstring>

#include "detect/bands.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detect/grid_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef BOLE_DETECT_GRID_KERNELS_ONCE
#define BOLE_DETECT_GRID_KERNELS_ONCE
namespace bole {
namespace {

// What is added before a truncation, so that it rounds down.
constexpr float kFar = 16384;

// What is read of each band at each border.
struct Borders {
  alignas(64) std::uint32_t pair[kMostGridBands][kGridLanes];  // sums of two neighbouring columns
  alignas(64) std::int32_t high[kMostGridBands][kGridLanes];   // what the first one leaves out
  alignas(64) float rest[kMostGridBands][kGridLanes];          // of the first column
};

// The sum to a column, not modulo 2^16.
std::int32_t whole_sum(const std::int32_t* coarse, std::uint16_t sum, int column) {
  const std::int32_t before = coarse[column / Bands::kCoarse];
  return before + static_cast<std::uint16_t>(sum - before);
}

}  // namespace
}  // namespace bole
#endif

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Ints = hn::CappedTag<std::int32_t, kGridLanes>;
using Floats = hn::RebindToFloat<Ints>;

HWY_INLINE void ReadBorders(const CellColumns& cells, Borders& borders) {
  const Floats d;
  const Ints di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  alignas(64) std::int32_t columns[kGridLanes];
  for (int band = 0; band < cells.bands; ++band) {
    const auto middle = hn::Set(d, cells.middle + cells.lean * static_cast<float>(band));
    for (int i = 0; i < kGridLanes; i += lanes) {
      const auto x = hn::Add(middle, hn::Load(d, cells.borders.data() + i));
      const auto whole = hn::Sub(hn::ConvertTo(di, hn::Add(x, hn::Set(d, kFar))),
                                 hn::Set(di, static_cast<std::int32_t>(kFar)));
      hn::Store(whole, di, columns + i);
      hn::Store(hn::Sub(x, hn::ConvertTo(d, whole)), d, borders.rest[band] + i);
    }
    const std::uint16_t* sums = cells.sums + band * cells.pitch;
    for (int i = 0; i < kGridLanes; ++i)
      std::memcpy(&borders.pair[band][i], sums + columns[i], sizeof(std::uint32_t));
    if (!cells.coarse) continue;
    const std::int32_t* coarse = cells.coarse + band * cells.coarse_pitch;
    for (int i = 0; i < kGridLanes; ++i) {
      const std::uint16_t sum = sums[columns[i]];
      borders.high[band][i] = whole_sum(coarse, sum, columns[i] + cells.margin) - sum;
    }
  }
}

// 16 times the sum to each border; modulo 2^20 where only the sums modulo 2^16 are known.
HWY_INLINE void SumToBorders(const CellColumns& cells, const Borders& borders, std::int32_t* out) {
  const Floats d;
  const Ints di;
  const hn::RebindToUnsigned<Ints> du;
  const auto low = hn::Set(di, 0xffff);
  const auto half = hn::Set(d, 0.5F), parts = hn::Set(d, float{CellSums::kParts});
  for (int k = 0; k < cells.bands * kGridLanes; k += static_cast<int>(hn::Lanes(d))) {
    const auto pair = hn::Load(du, borders.pair[0] + k);
    const auto first = hn::And(hn::BitCast(di, pair), low);
    const auto second = hn::BitCast(di, hn::ShiftRight<16>(pair));
    const auto level = hn::ConvertTo(d, hn::And(hn::Sub(second, first), low));
    const auto rest = hn::Mul(hn::Load(d, borders.rest[0] + k), hn::Mul(level, parts));
    const auto sum = cells.coarse ? hn::Add(first, hn::Load(di, borders.high[0] + k)) : first;
    hn::Store(hn::Add(hn::ShiftLeft<4>(sum), hn::ConvertTo(di, hn::Add(rest, half))), di, out + k);
  }
}

void SumCells(const CellColumns& cells, CellSums& sums) {
  static_assert(CellSums::kParts == 1 << 4);
  const Ints di;
  Borders borders;
  alignas(64) std::int32_t to_borders[kMostGridBands * kGridLanes + 1];
  ReadBorders(cells, borders);
  SumToBorders(cells, borders, to_borders);
  to_borders[cells.bands * kGridLanes] = 0;  // read beside the last cell
  const auto known = hn::Set(di, cells.coarse ? -1 : 0xfffff);
  for (int i = 0; i < kGridLanes; i += static_cast<int>(hn::Lanes(di))) {
    auto total = hn::Zero(di);
    hn::Store(total, di, sums.at[0] + i);
    for (int band = 0; band < cells.bands; ++band) {
      const std::int32_t* at = to_borders + band * kGridLanes + i;
      const auto cell = hn::And(hn::Sub(hn::LoadU(di, at + 1), hn::Load(di, at)), known);
      total = hn::Add(total, cell);
      hn::Store(total, di, sums.at[band + 1] + i);
    }
  }
}

}  // namespace bole::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bole {

HWY_EXPORT(SumCells);

void sum_cells(const CellColumns& cells, CellSums& sums) {
  HWY_DYNAMIC_DISPATCH(SumCells)(cells, sums);
}

void sum_cells_plain(const CellColumns& cells, CellSums& sums) {
  for (int i = 0; i + 1 < kGridLanes; ++i) {
    std::int32_t total = sums.at[0][i] = 0;
    for (int band = 0; band < cells.bands; ++band) {
      const std::uint16_t* at = cells.sums + band * cells.pitch;
      const auto to = [&](float border) {
        const float x = cells.middle + cells.lean * static_cast<float>(band) + border;
        const int column = static_cast<int>(x + kFar) - static_cast<int>(kFar);
        const auto level = static_cast<std::uint16_t>(at[column + 1] - at[column]);
        const float rest = (x - static_cast<float>(column)) *
                           (static_cast<float>(level) * float{CellSums::kParts});
        const int whole = cells.coarse ? whole_sum(cells.coarse + band * cells.coarse_pitch,
                                                   at[column], column + cells.margin)
                                       : at[column];
        return CellSums::kParts * whole + static_cast<int>(rest + 0.5F);
      };
      const int cell = to(cells.borders[i + 1]) - to(cells.borders[i]);
      total += cells.coarse ? cell : cell & (65536 * CellSums::kParts - 1);
      sums.at[band + 1][i] = total;
    }
  }
}

}  // namespace bole
#endif  // HWY_ONCE
