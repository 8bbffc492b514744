#pragma once

#include <optional>
#include <vector>

#include "evaluate/detections.h"
#include "evaluate/truth.h"
#include "geometry/panorama.h"

namespace bole {

/// The paper's figures at the level of panorama pixels. A pixel is trunk where the rectangle of a
/// tree that should be found covers it, from the base up to +25 degrees, and nothing where only
/// that of another marked tree does; frames that are not exhaustively marked have no background.
struct PixelRates {
  struct Point {
    double min_score = 0;
    double true_positive_rate = 0;   ///< share of the trunk pixels that detections cover
    double false_positive_rate = 0;  ///< share of the background pixels that detections cover
  };
  std::vector<Point> curve;  ///< by falling min_score, from 1 down to 0

  /// Median over frames of A(T & D)^2 / (A(T) A(D)), T all trunk pixels, D all pixels of
  /// detections at the given score; over frames that have both.
  std::optional<double> overlap;
};
PixelRates measure_pixel_rates(const Truth& truth, const Detections& detections,
                               const PanoramaGeometry& panorama, double min_score);

}  // namespace bole
