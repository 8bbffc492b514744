#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluate/detections.h"
#include "evaluate/truth.h"

namespace bole {

/// The figures of tools/score.py, equal to its own to the last printed digit.
struct Figures {
  int trees = 0;  ///< that should be found
  int tp = 0, fp = 0, fn = 0;
  double precision = 0, recall = 0, f1 = 0;
  double ap = 0;  ///< area under precision over recall
  /// Medians over true positives: error in position and in diameter, metres, and the overlap of
  /// rectangles. None where there is no true positive on a metric frame.
  std::optional<double> dp, dw, overlap;
};

/// The trees of each frame with score >= `min_score`, against the truth.
Figures measure(const Truth& truth, const Detections& detections, double min_score);

/// A detection that counts, with its score: what precision and recall, AP and reliability are made
/// of. By falling score.
struct Outcome {
  double score = 0;
  bool hit = false;
};
std::vector<Outcome> outcomes_of(const Truth& truth, const Detections& detections,
                                 double min_score);

/// Precision over recall, one point an outcome; precision as the best one at that recall or beyond.
struct RecallPrecision {
  double recall = 0, precision = 0;
};
std::vector<RecallPrecision> precision_curve(const std::vector<Outcome>& outcomes, int wanted);

/// The middle of `values`, the mean of the two middle ones of an even number; none of none.
std::optional<double> median(std::vector<double> values);

/// As score.py prints them: one line of JSON, fractions rounded to four digits.
std::string to_json(const Figures& figures);

}  // namespace bole
