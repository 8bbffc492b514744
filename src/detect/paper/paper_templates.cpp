#include "detect/paper/paper_templates.h"

#include <cmath>

#include "geometry/angles.h"
#include "geometry/ground.h"

namespace bole {
namespace {

constexpr int kSizes = 5;

std::vector<float> bar_of_width(double s) {
  std::vector<float> bar;
  for (int x = 0; x <= s; ++x) {
    bar.push_back(static_cast<float>(std::exp(-x * x / (2 * s * s)) * std::cos(kPi * x / s)));
  }
  return bar;
}

std::vector<double> depths_of(const Bounds& range) {
  std::vector<double> depths;
  const int last = static_cast<int>(std::floor(range.high));
  for (int depth = static_cast<int>(std::ceil(range.low)); depth <= last; ++depth) {
    depths.push_back(depth);
  }
  if (depths.empty()) depths.push_back(range.low);
  return depths;
}

}  // namespace

std::vector<PaperTemplate> paper_templates(const PanoramaGeometry& panorama, double height,
                                           const Search& search) {
  std::vector<PaperTemplate> templates;
  for (const double depth : depths_of(search.range)) {
    const double row = panorama.row_of_tangent(ground_tangent(depth, height));
    const int foot_row = static_cast<int>(std::lround(row));
    if (foot_row < 0 || foot_row >= panorama.rows) continue;
    for (int k = 0; k < kSizes; ++k) {
      PaperTemplate t;
      t.foot_distance = depth;
      t.foot_row = foot_row;
      t.diameter = std::lerp(search.diameter.low, search.diameter.high, k / (kSizes - 1.0));
      t.angular_width = angular_width(t.diameter, t.range());
      t.width_px = t.angular_width * panorama.focal();
      t.bar = bar_of_width(t.width_px);
      templates.push_back(std::move(t));
    }
  }
  return templates;
}

}  // namespace bole
