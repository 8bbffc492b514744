#include "detect/network/foot_patch.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>

#include "detect/contrast/bands.h"
#include "detect/network/foot_kernels.h"

namespace bole {
namespace {

constexpr int kRows = FootPatch::kRows, kAcross = FootPatch::kAcross;
constexpr float kStrip = 0.2F;     // of the trunk's width
constexpr int kCore = 4;           // strips
constexpr float kMost = 4;         // of a value
constexpr int kMostPixels = 2048;  // of a row, that all strips cover
constexpr int kParts = 16;         // of a row, that lines lie at

// What the strips cover of the picture at one line across the trunk.
class Line {
 public:
  // `at`: the row, 0 in the middle of the first one; `first`, `last`: columns, continuous.
  Line(const PanoramaView& panorama, bool wraps, float at, float first, float last)
      : first_(static_cast<int>(std::floor(first))) {
    const int rows = panorama.geometry->rows, width = panorama.geometry->width;
    const float inside = std::clamp(at, 0.0F, static_cast<float>(rows - 1));
    const int row = static_cast<int>(inside);
    const int low = static_cast<int>((inside - static_cast<float>(row)) * kParts);
    const std::uint8_t* const above = panorama.row(row);
    const std::uint8_t* const below = panorama.row(std::min(row + 1, rows - 1));
    const int count = std::min(static_cast<int>(last) + 1 - first_, kMostPixels);
    if (first_ >= 0 && first_ + count <= width) {
      add_up(above + first_, below + first_, low, count);
      return;
    }
    std::array<std::uint8_t, kMostPixels> upper, lower;
    for (int i = 0; i < count; ++i) {
      const int column = column_within(first_ + i, width, wraps);
      upper[i] = above[column];
      lower[i] = below[column];
    }
    add_up(upper.data(), lower.data(), low, count);
  }

  // Of the grey levels from the first pixel to this column, times kParts.
  float sum_to(float column) const {
    const float from_first = column - static_cast<float>(first_);
    const int whole = static_cast<int>(from_first);
    const auto sum = static_cast<float>(sums_[whole]);
    return sum + (from_first - static_cast<float>(whole)) *
                     static_cast<float>(sums_[whole + 1] - sums_[whole]);
  }

 private:
  void add_up(const std::uint8_t* above, const std::uint8_t* below, int low, int count) {
    std::array<std::uint16_t, kMostPixels> levels;
    std::transform(above, above + count, below, levels.begin(), [low](int a, int b) {
      return static_cast<std::uint16_t>(kParts * a + low * (b - a));
    });
    sums_[0] = 0;
    std::inclusive_scan(levels.begin(), levels.begin() + count, sums_.begin() + 1, std::plus<>(),
                        0);
  }

  int first_;
  std::array<int, kMostPixels + 1> sums_;
};

// Turns log brightness into what the patch holds.
void standardise_patch(FootPatch::Values& values, bool dark) {
  float core = 0;
  for (int j = 0; j < kRows / 2; ++j) {
    const float* const first = &values[j * kAcross + (kAcross - kCore) / 2];
    core = std::accumulate(first, first + kCore, core);
  }
  core /= float{kCore} * kRows / 2;
  const float mean = std::accumulate(values.begin(), values.end(), 0.0F) / FootPatch::kCount;
  const float squares = std::transform_reduce(values.begin(), values.end(), 0.0F, std::plus<>(),
                                              [&](float v) { return (v - mean) * (v - mean); });
  const float spread = std::sqrt(squares / FootPatch::kCount);
  const float scale = (dark ? 1.0F : -1.0F) / std::max(spread, Bands::kLeastSpread);
  for (float& value : values) value = std::clamp((value - core) * scale, -kMost, kMost);
}

}  // namespace

FootPatch::Values read_foot_patch(const PanoramaView& panorama, bool wraps, const float* log,
                                  const TrunkShape& shape, double focal) {
  const float step = 0.5F * foot_unit(shape, focal);
  const float strip = kStrip * std::min(shape.width(), (kMostPixels - 4) / (kStrip * kAcross));
  const float quarters = 4.0F / (kParts * strip);  // of a grey level, of a sum over a strip
  FootPatch::Values values;
  for (int j = 0; j < kRows; ++j) {
    const float down = (static_cast<float>(j) - 0.5F * (kRows - 1)) * step;
    const float first = shape.centre() + shape.slope() * down - 0.5F * kAcross * strip;
    const Line line(panorama, wraps, shape.foot + down - 0.5F, first, first + kAcross * strip);
    float sum = line.sum_to(first);
    for (int k = 0; k < kAcross; ++k) {
      const float next = line.sum_to(first + static_cast<float>(k + 1) * strip);
      const float level = (next - sum) * quarters;
      values[j * kAcross + k] = log[std::clamp(static_cast<int>(level), 0, kLogLevels - 1)];
      sum = next;
    }
  }
  standardise_patch(values, shape.dark);
  return values;
}

}  // namespace bole
