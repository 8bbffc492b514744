#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "detect/detector.h"
#include "geometry/angles.h"
#include "geometry/ground.h"
#include "simulate/noise.h"

namespace bole {

/// A panorama painted by hand: rough ground, bright sky over a dark hem of foliage, and trunks as
/// upright bars. Everything about it is known exactly.
class PaintedPanorama {
 public:
  struct Bar {
    double bearing, range, diameter;
    int grey;
    double raised = 0;  // the ground there, a tangent
  };

  explicit PaintedPanorama(const PanoramaGeometry& geometry, double height = 1.0)
      : geometry_(geometry),
        height_(height),
        pixels_(static_cast<std::size_t>(geometry.rows) * geometry.width),
        seen_(pixels_.size(), 1),
        columns_(geometry.width, SeenRows{0, static_cast<std::uint16_t>(geometry.rows)}) {
    const double horizon = geometry.horizon_row();
    for (int row = 0; row < geometry.rows; ++row) {
      for (int x = 0; x < geometry.width; ++x) {
        const double rough =
            6 * simulate::noise(static_cast<float>(x) * 0.21F, static_cast<float>(row) * 0.3F, 7U) +
            5 * simulate::noise(static_cast<float>(x) * 0.9F, static_cast<float>(row) * 0.8F, 9U);
        const double hem = horizon - 40 - 25 * simulate::noise(static_cast<float>(x) * 0.05F, 3U);
        at(row, x) = grey(row > horizon ? 120 + rough : row > hem ? 70 + 2 * rough : 215 + rough);
      }
    }
  }

  void plant(const Bar& bar) {
    const double width = angular_width(bar.diameter, bar.range) * geometry_.focal();
    const double foot = geometry_.row_of_tangent(
                            ground_tangent(bar.range - bar.diameter / 2, height_) + bar.raised) +
                        0.5;
    const double middle = geometry_.column_of_bearing(bar.bearing) + 0.5;
    for (int row = 0; row < geometry_.rows; ++row) {
      const double down = std::clamp(foot - row, 0.0, 1.0);
      for (int i = -geometry_.columns / 4; i < geometry_.columns / 4; ++i) {
        const double x = std::floor(middle) + i;
        const double across = std::clamp(
            std::min(x + 1, middle + width / 2) - std::max(x, middle - width / 2), 0.0, 1.0);
        int column = static_cast<int>(x);
        if (geometry_.wraps())
          column = (column % geometry_.width + geometry_.width) % geometry_.width;
        if (column < 0 || column >= geometry_.width || across * down <= 0) continue;
        const double bark = bar.grey + 4.0 * simulate::noise(static_cast<float>(x) * 0.7F,
                                                             static_cast<float>(row) * 0.1F, 5U);
        std::uint8_t& pixel = at(row, column);
        pixel = grey(pixel + across * down * (bark - pixel));
      }
    }
  }

  /// What fog makes of it: so much of the light is left, and so many grey levels are added.
  void draw_veil(double left, double added) {
    for (std::uint8_t& pixel : pixels_) pixel = grey(left * pixel + added);
  }
  /// So many pixels, the lowest, are not seen.
  void mask_last(std::size_t pixels) { std::fill_n(seen_.rbegin(), pixels, std::uint8_t{0}); }

  std::uint8_t& at(int row, int column) {
    return pixels_[static_cast<std::size_t>(row) * geometry_.width + column];
  }
  std::vector<std::uint8_t>& pixels() { return pixels_; }
  SeenMap seen() const { return {seen_, columns_}; }
  PanoramaView view() const { return {&geometry_, pixels_.data(), geometry_.width}; }
  DetectorSetup setup(const Search& search = {}) const {
    return {geometry_, seen(), height_, search};
  }

 private:
  static std::uint8_t grey(double value) {
    return static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0));
  }

  PanoramaGeometry geometry_;
  double height_;
  std::vector<std::uint8_t> pixels_, seen_;
  std::vector<SeenRows> columns_;
};

}  // namespace bole
