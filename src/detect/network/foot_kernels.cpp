#include "detect/network/foot_kernels.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "detect/rounding.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detect/network/foot_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef BOLE_DETECT_FOOT_KERNELS_ONCE
#define BOLE_DETECT_FOOT_KERNELS_ONCE
namespace bole {
namespace {

constexpr int kLines = FootLines::kLines, kMiddle = kLines / 2, kStrips = FootLines::kStrips;

// The rows that the lines lie between: each once where lines share them, else two by two.
struct FootRows {
  static constexpr int kMost = 2 * kLines;
  int count = 0;
  alignas(64) std::int32_t at[kMost];              // ascending, then the last one again
  alignas(64) std::int32_t first[kStrips][kMost];  // columns of the strips: [first, last)
  alignas(64) std::int32_t last[kStrips][kMost];
  alignas(64) std::int32_t sum[kStrips][kMost];  // of their pixels
  alignas(64) float mean[kStrips][kMost];        // log brightness
};

// A line's two rows, as places among FootRows, and how much they count.
struct LineRows {
  alignas(64) std::int32_t at[2][kLines];
  alignas(64) float weight[2][kLines];
};

// How far the three strips reach from the middle.
struct StripBorders {
  float gap, far, core;
  explicit StripBorders(float width)
      : gap(0.5F * width + std::max(1.0F, 0.1F * width)),
        far(gap + std::max(2.0F, 0.5F * width)),
        core(0.28F * width) {}
};

}  // namespace
}  // namespace bole
#endif

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kLines>;
using Ints = hn::RebindToSigned<Floats>;
using Pixels = hn::CappedTag<std::uint8_t, 32>;

HWY_INLINE hn::Vec<Ints> Nearest(hn::Vec<Floats> x) {
  const Floats d;
  const auto far = hn::Add(hn::Add(x, hn::Set(d, 0.5F)), hn::Set(d, kFar));
  return hn::Sub(hn::ConvertTo(Ints(), far), hn::Set(Ints(), static_cast<std::int32_t>(kFar)));
}

HWY_INLINE void FindRows(const FootPlace& place, int rows, LineRows& lines, FootRows& all) {
  const Floats d;
  const Ints di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const float spacing = std::max(1.0F, 0.5F * place.unit);
  const auto half = hn::Set(d, 0.5F);
  for (int j = 0; j < kLines; j += lanes) {
    const auto line = hn::Add(hn::Iota(d, static_cast<float>(j - kMiddle)), half);
    const auto at =
        hn::Sub(hn::Add(hn::Set(d, place.row), hn::Mul(line, hn::Set(d, place.unit))), half);
    const auto high = spacing > 1 ? hn::Sub(at, hn::Set(d, 0.5F * spacing)) : hn::Floor(at);
    const auto low_weight = spacing > 1 ? half : hn::Sub(at, high);
    hn::Store(hn::Sub(hn::Set(d, 1.0F), low_weight), d, lines.weight[0] + j);
    hn::Store(low_weight, d, lines.weight[1] + j);
    for (int k = 0; k < 2; ++k) {
      const auto row = Nearest(hn::Add(high, hn::Set(d, static_cast<float>(k) * spacing)));
      hn::Store(hn::Min(hn::Max(row, hn::Zero(di)), hn::Set(di, rows - 1)), di, lines.at[k] + j);
    }
  }
  const std::int32_t top = lines.at[0][0], bottom = lines.at[1][kLines - 1];
  const bool shared = bottom - top < FootRows::kMost;
  all.count = shared ? bottom - top + 1 : FootRows::kMost;
  for (int j = 0; j < kLines; j += lanes) {
    if (shared) {
      for (int k = 0; k < 2; ++k) {
        const auto row = hn::Min(hn::Iota(di, top + j + k * kLines), hn::Set(di, bottom));
        hn::Store(row, di, all.at + j + k * kLines);
        hn::Store(hn::Sub(hn::Load(di, lines.at[k] + j), hn::Set(di, top)), di, lines.at[k] + j);
      }
    } else {
      for (int k = 0; k < 2; ++k) {
        hn::Store(hn::Load(di, lines.at[k] + j), di, all.at + j + k * kLines);
        hn::Store(hn::Iota(di, j + k * kLines), di, lines.at[k] + j);
      }
    }
  }
}

HWY_INLINE void FindStrips(const FootPlace& place, FootRows& rows) {
  const Floats d;
  const Ints di;
  const StripBorders borders(place.width);
  const auto half = hn::Set(d, 0.5F), foot = hn::Set(d, place.row);
  for (int i = 0; i < rows.count; i += static_cast<int>(hn::Lanes(d))) {
    const auto row = hn::ConvertTo(d, hn::Load(di, rows.at + i));
    const auto below = hn::Sub(hn::Add(row, half), foot);
    const auto middle = hn::Add(hn::Set(d, place.middle), hn::Mul(hn::Set(d, place.lean), below));
    const auto before = [&](float off) { return Nearest(hn::Sub(middle, hn::Set(d, off))); };
    const auto after = [&](float off) { return Nearest(hn::Add(middle, hn::Set(d, off))); };
    const auto core = before(borders.core);
    hn::Store(before(borders.far), di, rows.first[0] + i);
    hn::Store(before(borders.gap), di, rows.last[0] + i);
    hn::Store(core, di, rows.first[1] + i);
    hn::Store(hn::Max(after(borders.core), hn::Add(core, hn::Set(di, 1))), di, rows.last[1] + i);
    hn::Store(after(borders.gap), di, rows.first[2] + i);
    hn::Store(after(borders.far), di, rows.last[2] + i);
  }
}

// The sum of `count` pixels before `end`, in as many parts as there are lanes. May read before
// them, less than a vector.
HWY_INLINE hn::Vec<hn::Repartition<std::uint64_t, Pixels>> SumBefore(const std::uint8_t* end,
                                                                     int count) {
  const Pixels d;
  const hn::Repartition<std::uint64_t, Pixels> d64;
  const int lanes = static_cast<int>(hn::Lanes(d));
  auto sums = hn::Zero(d64);
  for (; count > lanes; count -= lanes, end -= lanes)
    sums = hn::Add(sums, hn::SumsOf8(hn::LoadU(d, end - lanes)));
  const auto others = hn::FirstN(d, static_cast<std::size_t>(lanes - std::max(count, 0)));
  return hn::Add(sums, hn::SumsOf8(hn::IfThenZeroElse(others, hn::LoadU(d, end - lanes))));
}

// The three sums go side by side in one number of 64 bits.
HWY_INLINE void SumInside(const std::uint8_t* pixels, FootRows& rows, int i) {
  const hn::Repartition<std::uint64_t, Pixels> d64;
  const auto strip = [&](int k) {
    return SumBefore(pixels + rows.last[k][i], rows.last[k][i] - rows.first[k][i]);
  };
  const auto all =
      hn::Add(strip(0), hn::Add(hn::ShiftLeft<21>(strip(1)), hn::ShiftLeft<42>(strip(2))));
  const std::uint64_t sums = hn::GetLane(hn::SumOfLanes(d64, all));
  constexpr std::uint64_t kOne = (std::uint64_t{1} << 21) - 1;
  rows.sum[0][i] = static_cast<std::int32_t>(sums & kOne);
  rows.sum[1][i] = static_cast<std::int32_t>(sums >> 21 & kOne);
  rows.sum[2][i] = static_cast<std::int32_t>(sums >> 42);
}

// The same beyond a border.
void SumRound(const std::uint8_t* pixels, int width, bool wraps, FootRows& rows, int i) {
  const hn::Repartition<std::uint64_t, Pixels> d64;
  for (int k = 0; k < kStrips; ++k) {
    rows.sum[k][i] = 0;
    for (const int turn : {-1, 0, 1}) {
      const int first = std::max(rows.first[k][i] - turn * width, 0);
      const int last = std::min(rows.last[k][i] - turn * width, width);
      if (last <= first) continue;
      if (turn == 0 || wraps) {
        const auto sums = SumBefore(pixels + last, last - first);
        rows.sum[k][i] += static_cast<int>(hn::GetLane(hn::SumOfLanes(d64, sums)));
      } else {
        rows.sum[k][i] += (last - first) * pixels[turn < 0 ? 0 : width - 1];
      }
    }
  }
}

HWY_INLINE void TakeMeans(const float* log, FootRows& rows) {
  const Floats d;
  const Ints di;
  for (int i = 0; i < rows.count; i += static_cast<int>(hn::Lanes(d))) {
    for (int k = 0; k < kStrips; ++k) {
      const auto sum = hn::ConvertTo(d, hn::Load(di, rows.sum[k] + i));
      const auto count = hn::ConvertTo(
          d, hn::Sub(hn::Load(di, rows.last[k] + i), hn::Load(di, rows.first[k] + i)));
      // A quotient of whole numbers, rounded down: the half keeps it off the next one.
      const auto quarters =
          hn::Div(hn::Add(hn::Mul(hn::Set(d, 4.0F), sum), hn::Set(d, 0.5F)), count);
      hn::Store(hn::GatherIndex(d, log, hn::ConvertTo(di, quarters)), d, rows.mean[k] + i);
    }
  }
}

void ReadFootLines(const PanoramaView& panorama, bool wraps, const float* log,
                   const FootPlace& place, FootLines& out) {
  const Floats d;
  const Ints di;
  const int width = panorama.geometry->width;
  LineRows lines;
  FootRows rows;
  FindRows(place, panorama.geometry->rows, lines, rows);
  // Before the first row there is nothing to read.
  if (rows.at[0] == 0 || panorama.stride < static_cast<int>(hn::Lanes(Pixels())))
    return read_foot_lines_plain(panorama, wraps, log, place, out);
  FindStrips(place, rows);
  for (int i = 0; i < rows.count; ++i) {
    const std::uint8_t* pixels = panorama.row(rows.at[i]);
    if (rows.first[0][i] >= 0 && rows.last[2][i] <= width) {
      SumInside(pixels, rows, i);
    } else {
      SumRound(pixels, width, wraps, rows, i);
    }
  }
  for (int i = rows.count; i % kLines != 0; ++i)
    for (int k = 0; k < kStrips; ++k) rows.sum[k][i] = 0;
  TakeMeans(log, rows);
  for (int j = 0; j < kLines; j += static_cast<int>(hn::Lanes(d))) {
    for (int k = 0; k < kStrips; ++k) {
      const auto part = [&](int which) {
        const auto mean = hn::GatherIndex(d, rows.mean[k], hn::Load(di, lines.at[which] + j));
        return hn::Mul(hn::Load(d, lines.weight[which] + j), mean);
      };
      hn::Store(hn::Add(part(0), part(1)), d, out.at[k].data() + j);
    }
  }
}

}  // namespace bole::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bole {

HWY_EXPORT(ReadFootLines);

void read_foot_lines(const PanoramaView& panorama, bool wraps, const float* log,
                     const FootPlace& place, FootLines& lines) {
  HWY_DYNAMIC_DISPATCH(ReadFootLines)(panorama, wraps, log, place, lines);
}

void read_foot_lines_plain(const PanoramaView& panorama, bool wraps, const float* log,
                           const FootPlace& place, FootLines& lines) {
  const int rows = panorama.geometry->rows, width = panorama.geometry->width;
  const StripBorders borders(place.width);
  const auto nearest = [](float x) {
    return static_cast<int>(x + 0.5F + kFar) - static_cast<int>(kFar);
  };
  const auto mean = [&](int row, int first, int last) {
    int sum = 0;
    for (int x = first; x < last; ++x) {
      sum += panorama.row(row)[column_within(x, width, wraps)];
    }
    return log[static_cast<int>((4 * static_cast<float>(sum) + 0.5F) /
                                static_cast<float>(last - first))];
  };
  const float spacing = std::max(1.0F, 0.5F * place.unit);
  for (int j = 0; j < kLines; ++j) {
    const float line = place.row + (static_cast<float>(j - kMiddle) + 0.5F) * place.unit - 0.5F;
    const float high = spacing > 1 ? line - 0.5F * spacing : std::floor(line);
    const float low_weight = spacing > 1 ? 0.5F : line - high;
    for (int k = 0; k < kStrips; ++k) lines.at[k][j] = 0;
    for (const int which : {0, 1}) {
      const int row = std::clamp(nearest(high + static_cast<float>(which) * spacing), 0, rows - 1);
      const float weight = which == 0 ? 1 - low_weight : low_weight;
      const float middle = place.middle + place.lean * (static_cast<float>(row) + 0.5F - place.row);
      const int core = nearest(middle - borders.core);
      const float means[kStrips] = {
          mean(row, nearest(middle - borders.far), nearest(middle - borders.gap)),
          mean(row, core, std::max(nearest(middle + borders.core), core + 1)),
          mean(row, nearest(middle + borders.gap), nearest(middle + borders.far))};
      for (int k = 0; k < kStrips; ++k) lines.at[k][j] += weight * means[k];
    }
  }
}

}  // namespace bole
#endif  // HWY_ONCE
