#include "evaluate/pixel_rates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "evaluate/figures.h"
#include "evaluate/matching.h"
#include "geometry/angles.h"
#include "geometry/ground.h"

namespace bole {
namespace {

constexpr int kLevels = 200;  // of the score, each a threshold

enum class Label : std::uint8_t { background, nothing, trunk };

// One frame's panorama from +25 degrees down, a value a pixel.
template <class Value>
class Canvas {
 public:
  explicit Canvas(const PanoramaGeometry& panorama, Value value)
      : panorama_(panorama),
        pixels_(static_cast<std::size_t>(panorama.columns) * panorama.rows, value) {}

  /// Raises all pixels of the rectangle to at least `value`.
  void raise(double bearing, double width, double base_elevation, Value value) {
    const double centre = panorama_.column_of_bearing(bearing);
    const double half = std::min(width * panorama_.focal(), panorama_.columns - 1.0) / 2;
    const int last_row =
        static_cast<int>(std::floor(panorama_.row_of_tangent(std::tan(base_elevation))));
    for (int i = first_row(); i <= std::min(last_row, panorama_.rows - 1); ++i) {
      Value* row = &pixels_[static_cast<std::size_t>(i) * panorama_.columns];
      for (int j = static_cast<int>(std::ceil(centre - half)); j <= centre + half; ++j) {
        Value& pixel = row[(j + 2 * panorama_.columns) % panorama_.columns];
        pixel = std::max(pixel, value);
      }
    }
  }

  /// Those that count: rows from +25 degrees down.
  std::span<const Value> pixels() const {
    return std::span(pixels_).subspan(static_cast<std::size_t>(first_row()) * panorama_.columns);
  }

 private:
  int first_row() const {
    return std::max(0,
                    static_cast<int>(std::ceil(panorama_.row_of_tangent(std::tan(radians(25))))));
  }

  PanoramaGeometry panorama_;
  std::vector<Value> pixels_;
};

Canvas<Label> draw_truth(const TruthFrame& frame, const PanoramaGeometry& panorama, double height) {
  Canvas<Label> labels(panorama, frame.exhaustive ? Label::background : Label::nothing);
  for (const TruthTree& tree : frame.trees) {
    if (!frame.metric) {
      labels.raise(tree.bearing, tree.angular_width, tree.base_elevation, Label::trunk);
      continue;
    }
    const double foot = std::max(*tree.range - tree.diameter / 2, 0.1);
    labels.raise(tree.bearing, angular_width(tree.diameter, *tree.range), std::atan2(-height, foot),
                 eligible(tree) ? Label::trunk : Label::nothing);
  }
  return labels;
}

// 0 where no detection is, k + 1 where the best one's score lies in level k.
Canvas<std::uint8_t> draw_detections(const std::vector<Tree>& trees,
                                     const PanoramaGeometry& panorama) {
  Canvas<std::uint8_t> levels(panorama, 0);
  for (const Tree& tree : trees) {
    const int level = std::clamp(static_cast<int>(tree.score * kLevels), 0, kLevels - 1);
    levels.raise(tree.bearing, tree.angular_width, tree.base_elevation,
                 static_cast<std::uint8_t>(level + 1));
  }
  return levels;
}

using Histogram = std::array<std::int64_t, kLevels + 1>;

std::int64_t at_least(const Histogram& counts, int level) {
  std::int64_t sum = 0;
  for (int k = level; k <= kLevels; ++k) sum += counts[k];
  return sum;
}

// The frame's overlap of all trunk pixels with all pixels of detections.
std::optional<double> overlap_of(std::span<const Label> labels,
                                 std::span<const std::uint8_t> levels, double min_score) {
  const int level = static_cast<int>(std::ceil(min_score * kLevels)) + 1;
  double trunk = 0, found = 0, both = 0;
  for (std::size_t k = 0; k < labels.size(); ++k) {
    const bool in_truth = labels[k] == Label::trunk;
    const bool in_detection = levels[k] >= level && labels[k] != Label::nothing;
    trunk += in_truth ? 1 : 0;
    found += in_detection ? 1 : 0;
    both += in_truth && in_detection ? 1 : 0;
  }
  if (trunk == 0 || found == 0) return std::nullopt;
  return both * both / (trunk * found);
}

}  // namespace

PixelRates measure_pixel_rates(const Truth& truth, const Detections& detections,
                               const PanoramaGeometry& kept, double min_score) {
  PanoramaGeometry panorama = kept;  // the full turn
  panorama.first_column = 0;
  panorama.width = panorama.columns;
  Histogram on_trunks{}, on_background{};
  std::vector<double> overlaps;
  for (const TruthFrame& frame : truth.frames) {
    const auto found = detections.find(frame.file);
    const Canvas<Label> labels = draw_truth(frame, panorama, truth.height);
    const Canvas<std::uint8_t> levels =
        draw_detections(found == detections.end() ? std::vector<Tree>{} : found->second, panorama);
    const auto label = labels.pixels();
    const auto level = levels.pixels();
    for (std::size_t k = 0; k < label.size(); ++k) {
      if (label[k] == Label::trunk) ++on_trunks[level[k]];
      if (label[k] == Label::background) ++on_background[level[k]];
    }
    if (const auto overlap = overlap_of(label, level, min_score)) overlaps.push_back(*overlap);
  }
  PixelRates rates;
  const auto share = [](const Histogram& counts, int level) {
    const auto all = static_cast<double>(std::max<std::int64_t>(1, at_least(counts, 0)));
    return static_cast<double>(at_least(counts, level)) / all;
  };
  for (int level = kLevels + 1; level > 0; --level) {
    rates.curve.push_back({static_cast<double>(level - 1) / kLevels, share(on_trunks, level),
                           share(on_background, level)});
  }
  rates.overlap = median(std::move(overlaps));
  return rates;
}

}  // namespace bole
