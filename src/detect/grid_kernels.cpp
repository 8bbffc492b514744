#include "detect/grid_kernels.h"

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

// 16 times the sum to each border; modulo 2^20 where only the sums modulo 2^16 are known.
HWY_INLINE void SumToBorders(const CellColumns& cells, std::int32_t* out) {
  const Floats d;
  const Ints di;
  const auto low = hn::Set(di, 0xffff), far = hn::Set(di, static_cast<std::int32_t>(kFar));
  const auto half = hn::Set(d, 0.5F), parts = hn::Set(d, float{CellSums::kParts});
  for (int band = 0; band < cells.bands; ++band) {
    const auto middle = hn::Set(d, cells.middle + cells.lean * static_cast<float>(band));
    // Two neighbouring sums at a time.
    const auto* pairs = reinterpret_cast<const std::int32_t*>(cells.sums + band * cells.pitch);
    for (int i = 0; i < kGridLanes; i += static_cast<int>(hn::Lanes(d))) {
      const auto x = hn::Add(middle, hn::Load(d, cells.borders.data() + i));
      const auto column = hn::Sub(hn::ConvertTo(di, hn::Add(x, hn::Set(d, kFar))), far);
      const auto pair = hn::GatherOffset(di, pairs, hn::ShiftLeft<1>(column));
      auto sum = hn::And(pair, low);
      const auto level = hn::And(hn::Sub(hn::ShiftRight<16>(pair), sum), low);
      if (cells.coarse) {
        const auto before =
            hn::GatherIndex(di, cells.coarse + band * cells.coarse_pitch,
                            hn::ShiftRight<5>(hn::Add(column, hn::Set(di, cells.margin))));
        sum = hn::Add(before, hn::And(hn::Sub(sum, before), low));
      }
      const auto rest =
          hn::Mul(hn::Sub(x, hn::ConvertTo(d, column)), hn::Mul(hn::ConvertTo(d, level), parts));
      hn::Store(hn::Add(hn::ShiftLeft<4>(sum), hn::ConvertTo(di, hn::Add(rest, half))), di,
                out + band * kGridLanes + i);
    }
  }
}

void SumCells(const CellColumns& cells, CellSums& sums) {
  static_assert(CellSums::kParts == 1 << 4 && Bands::kCoarse == 1 << 5);
  const Ints di;
  alignas(64) std::int32_t to_borders[kMostGridBands * kGridLanes + 1];
  SumToBorders(cells, to_borders);
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
        // The rest is not negative, and std::lround would be a call.
        // NOLINTNEXTLINE(bugprone-incorrect-roundings)
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
