#pragma once

#include "evaluate/figures.h"
#include "evaluate/pixel_rates.h"
#include "evaluate/reliability.h"
#include "evaluate/tracking_figures.h"

namespace bole {

/// All that is measured of the lists of drives once they are tracked.
struct TrackedEvaluation {
  TrackingFigures ids;
  Figures figures;  ///< of trees with at least min_score
  double calibration_error = 0;
  RangeTrust range_trust;
};

/// All that is measured of one detector on one set of frames.
struct Evaluation {
  double min_score = 0.5;
  Figures figures;                         ///< of trees with at least min_score
  double ap_of_all = 0;                    ///< average precision over trees of any score
  std::vector<RecallPrecision> precision;  ///< over trees of any score
  Reliability reliability;
  RangeTrust range_trust;
  PixelRates pixels;
  std::optional<TrackedEvaluation> tracked;  ///< where frames have ids
};

/// `detections`: each frame by itself, any score; `tracked`: the same with ids.
Evaluation evaluate(const Truth& truth, const Detections& detections, const Detections& tracked,
                    const PanoramaGeometry& panorama, double min_score);

/// One line of JSON: score.py's keys and the others beside them.
std::string to_json(const Evaluation& evaluation);
/// For people: a line a figure, one column an evaluation.
std::string to_table(const std::vector<std::pair<std::string, Evaluation>>& evaluations);

}  // namespace bole
