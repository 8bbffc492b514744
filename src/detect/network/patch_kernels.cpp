#include "detect/network/patch_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "detect/rounding.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detect/network/patch_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef BOLE_DETECT_PATCH_KERNELS_ONCE
#define BOLE_DETECT_PATCH_KERNELS_ONCE
namespace bole {
namespace {

constexpr int kBorders = kPatchSide + 1, kVectorBorders = 48;  // whole vectors of at most 16
constexpr float kMostOut = 127;
// More than there are between black and white; and the squares about the mean of a patch of levels
// up to this add up to less than 2^32.
constexpr float kMostLevel = 4095;
static_assert(kPatchParts == 1 << 4);

struct BorderBuffers {
  alignas(64) std::int32_t columns[kVectorBorders];
  alignas(64) std::int32_t rests[kVectorBorders];  // parts of a column beyond it
  alignas(64) std::int32_t pairs[kVectorBorders];  // sums at the column and the next
};

// What levels are multiplied by, of the sum of their squares about the mean.
float scale_of(std::uint64_t squares, float factor, float least_spread) {
  constexpr float kCells = kPatchSide * kPatchSide;
  const float spread = std::sqrt(static_cast<float>(squares) / kCells);
  return factor / std::max(spread, least_spread * PatchCells::kLevels);
}

}  // namespace
}  // namespace bole
#endif

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Ints = hn::CappedTag<std::int32_t, 16>;
using Floats = hn::RebindToFloat<Ints>;

HWY_INLINE void FindBorders(const PatchColumns& columns, BorderBuffers& borders) {
  const Floats d;
  const Ints di;
  const auto first = hn::Set(d, columns.first), cell = hn::Set(d, columns.cell);
  const auto least = hn::Set(di, columns.least * kPatchParts);
  const auto most = hn::Set(di, columns.last * kPatchParts);
  for (int i = 0; i < kVectorBorders; i += static_cast<int>(hn::Lanes(d))) {
    const auto column = hn::Add(first, hn::Mul(cell, hn::Iota(d, static_cast<float>(i))));
    const auto far = hn::Add(hn::Mul(column, hn::Set(d, float{kPatchParts})),
                             hn::Set(d, float{kPatchParts} * kFar + 0.5F));
    const auto part =
        hn::Sub(hn::ConvertTo(di, far), hn::Set(di, kPatchParts * static_cast<std::int32_t>(kFar)));
    const auto at = hn::Min(hn::Max(part, least), most);
    hn::Store(hn::ShiftRight<4>(at), di, borders.columns + i);
    hn::Store(hn::And(at, hn::Set(di, kPatchParts - 1)), di, borders.rests + i);
  }
}

void AddCells(const std::uint16_t* sums, const PatchColumns& columns, std::int32_t* cells) {
  const Ints di;
  const auto low = hn::Set(di, 0xffff);
  BorderBuffers borders;
  FindBorders(columns, borders);
  // One by one: gather instructions take longer.
  for (int i = 0; i < kBorders; ++i)
    std::memcpy(&borders.pairs[i], sums + borders.columns[i], sizeof(std::int32_t));
  std::fill(borders.pairs + kBorders, borders.pairs + kVectorBorders, 0);
  for (int i = 0; i < kVectorBorders; i += static_cast<int>(hn::Lanes(di))) {
    const auto pair = hn::Load(di, borders.pairs + i);
    const auto sum = hn::And(pair, low);
    const auto level = hn::And(hn::Sub(hn::ShiftRight<16>(pair), sum), low);
    hn::Store(sum, di, borders.pairs + i);
    hn::Store(hn::Mul(level, hn::Load(di, borders.rests + i)), di, borders.rests + i);
  }
  for (int i = 0; i < kPatchSide; i += static_cast<int>(hn::Lanes(di))) {
    const auto between = [&](const std::int32_t* at) {
      return hn::Sub(hn::LoadU(di, at + i + 1), hn::Load(di, at + i));
    };
    const auto whole = hn::ShiftLeft<4>(hn::And(between(borders.pairs), low));
    const auto cell = hn::Add(whole, between(borders.rests));
    hn::StoreU(hn::Add(hn::LoadU(di, cells + i), cell), di, cells + i);
  }
}

void StandardiseCells(const PatchCells& cells, float factor, float least_spread, std::int8_t* out) {
  const Floats d;
  const Ints di;
  const hn::Rebind<std::int8_t, Ints> d8;
  const int lanes = static_cast<int>(hn::Lanes(d));
  alignas(64) std::int32_t levels[kPatchSide][kPatchSide];
  auto total = hn::Zero(di);
  for (int y = 0; y < kPatchSide; ++y) {
    const auto by = hn::Set(d, cells.factors[y]);
    for (int x = 0; x < kPatchSide; x += lanes) {
      const auto sum = hn::ConvertTo(d, hn::Load(di, cells.sums[y].data() + x));
      const auto level = hn::Min(hn::Max(hn::Mul(sum, by), hn::Zero(d)), hn::Set(d, kMostLevel));
      const auto whole = hn::ConvertTo(di, level);
      total = hn::Add(total, whole);
      hn::Store(whole, di, levels[y] + x);
    }
  }
  alignas(64) std::int32_t parts[16];
  hn::Store(total, di, parts);
  const auto mean =
      hn::Set(di, std::accumulate(parts, parts + lanes, 0) / (kPatchSide * kPatchSide));
  const hn::RebindToUnsigned<Ints> du;
  auto squares = hn::Zero(du);
  for (auto& row : levels) {
    for (int x = 0; x < kPatchSide; x += lanes) {
      const auto off = hn::Sub(hn::Load(di, row + x), mean);
      squares = hn::Add(squares, hn::BitCast(du, hn::Mul(off, off)));
      hn::Store(off, di, row + x);
    }
  }
  alignas(64) std::uint32_t sums[16];
  hn::Store(squares, du, sums);
  const auto scale = hn::Set(
      d, scale_of(std::accumulate(sums, sums + lanes, std::uint64_t{0}), factor, least_spread));
  const auto most = hn::Set(d, kMostOut), far = hn::Set(d, kFar + 0.5F);
  for (const auto& row : levels) {
    for (int x = 0; x < kPatchSide; x += lanes, out += lanes) {
      const auto value = hn::Mul(hn::ConvertTo(d, hn::Load(di, row + x)), scale);
      const auto bound = hn::Add(hn::Min(most, hn::Max(hn::Neg(most), value)), far);
      const auto whole =
          hn::Sub(hn::ConvertTo(di, bound), hn::Set(di, static_cast<std::int32_t>(kFar)));
      hn::StoreU(hn::DemoteTo(d8, whole), d8, out);
    }
  }
}

}  // namespace bole::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bole {

HWY_EXPORT(AddCells);
HWY_EXPORT(StandardiseCells);

void add_cells(const std::uint16_t* sums, const PatchColumns& columns, std::int32_t* cells) {
  HWY_DYNAMIC_DISPATCH(AddCells)(sums, columns, cells);
}

void standardise_cells(const PatchCells& cells, float factor, float least_spread,
                       std::int8_t* out) {
  HWY_DYNAMIC_DISPATCH(StandardiseCells)(cells, factor, least_spread, out);
}

void add_cells_plain(const std::uint16_t* sums, const PatchColumns& columns, std::int32_t* cells) {
  const auto border = [&](int i) {
    const float far = (columns.first + columns.cell * static_cast<float>(i)) * kPatchParts +
                      (float{kPatchParts} * kFar + 0.5F);
    return std::clamp(static_cast<int>(far) - kPatchParts * static_cast<int>(kFar),
                      columns.least * kPatchParts, columns.last * kPatchParts);
  };
  for (int i = 0; i < kPatchSide; ++i) {
    const int from = border(i), to = border(i + 1);
    const auto rest = [&](int at) {
      const std::uint16_t* const sum = sums + (at >> 4);
      return (at & (kPatchParts - 1)) * static_cast<std::uint16_t>(sum[1] - sum[0]);
    };
    cells[i] += kPatchParts * static_cast<std::uint16_t>(sums[to >> 4] - sums[from >> 4]) +
                rest(to) - rest(from);
  }
}

void standardise_cells_plain(const PatchCells& cells, float factor, float least_spread,
                             std::int8_t* out) {
  std::array<std::array<int, kPatchSide>, kPatchSide> levels;
  int total = 0;
  for (int y = 0; y < kPatchSide; ++y) {
    for (int x = 0; x < kPatchSide; ++x) {
      const float level = static_cast<float>(cells.sums[y][x]) * cells.factors[y];
      total += levels[y][x] = static_cast<int>(std::clamp(level, 0.0F, kMostLevel));
    }
  }
  const int mean = total / (kPatchSide * kPatchSide);
  std::uint64_t squares = 0;
  for (const auto& row : levels) {
    for (const int level : row)
      squares += static_cast<std::uint64_t>((level - mean) * (level - mean));
  }
  const float scale = scale_of(squares, factor, least_spread);
  for (const auto& row : levels) {
    for (const int level : row) {
      const float value = std::clamp(static_cast<float>(level - mean) * scale, -kMostOut, kMostOut);
      *out++ = static_cast<std::int8_t>(static_cast<int>(value + (kFar + 0.5F)) -
                                        static_cast<int>(kFar));
    }
  }
}

}  // namespace bole
#endif  // HWY_ONCE
