#include "detect/row_contrasts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

namespace bole {
namespace {

using F = TrunkFeatures;

constexpr float kLeastSpread = 0.04F;     // of log brightness, that is made full contrast
constexpr float kLeastLogSpread = 0.02F;  // that is told apart from less

struct Moments {
  float mean = 0, spread = 0;
};

Moments moments(std::span<const float> values) {
  const auto n = static_cast<float>(values.size());
  const float mean = std::accumulate(values.begin(), values.end(), 0.0F) / n;
  const float squares = std::inner_product(values.begin(), values.end(), values.begin(), 0.0F) / n;
  return {mean, std::sqrt(std::max(0.0F, squares - mean * mean))};
}

}  // namespace

void even_contrasts(float unit, float* grid, float* foot, float* out) {
  std::array<float, F::kHeights> inside;
  for (int h = 0; h < F::kHeights; ++h) {
    float* row = grid + h * F::kAcross;
    const Moments all = moments({row, F::kAcross}), within = moments({row + 4, 4});
    const float full = std::max(all.spread, kLeastSpread / unit);
    for (int i = 0; i < F::kAcross; ++i) row[i] = (row[i] - all.mean) / full;
    // Beside the edge, not upon it: it is never quite where the outline has it.
    const float left = 0.5F * (row[1] + row[2] - row[4] - row[5]);
    const float right = 0.5F * (row[9] + row[10] - row[6] - row[7]);
    const float values[] = {all.mean,
                            std::log(std::max(all.spread * unit, kLeastLogSpread)),
                            std::abs(left),
                            std::abs(right),
                            std::min(std::abs(left), std::abs(right)),
                            left * right,
                            within.spread / full};
    static_assert(std::size(values) == F::kRowNumbers);
    for (int k = 0; k < F::kRowNumbers; ++k) out[k * F::kHeights + h] = values[k];
    inside[h] = within.mean;
  }
  out += F::kRowNumbers * F::kHeights;
  for (int h = 0; h + 1 < F::kHeights; ++h) *out++ = std::abs(inside[h + 1] - inside[h]);

  const std::span<float> lines(foot, std::size_t{F::kFootRows} * F::kStrips);
  const float squares = std::inner_product(lines.begin(), lines.end(), lines.begin(), 0.0F);
  const float full =
      std::max(std::sqrt(squares / static_cast<float>(lines.size())), kLeastSpread / unit);
  for (float& value : lines) value = std::clamp(value / full, -4.0F, 4.0F);
  *out = std::log(full * unit);
}

}  // namespace bole
