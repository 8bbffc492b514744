#pragma once

#include <array>
#include <span>

#include "evaluate/figures.h"

namespace bole {

/// How far scores can be taken as probabilities: ten equal intervals of the score.
struct Reliability {
  struct Bin {
    int count = 0;
    double mean_score = 0;  ///< 0 where the bin is empty
    double hit_share = 0;
  };
  std::array<Bin, 10> bins;
  /// Expected calibration error: mean over detections of |hit share - mean score| of their bin.
  double calibration_error = 0;
};
Reliability measure_reliability(std::span<const Outcome> outcomes);

/// Share of the hits on metric frames whose true range lies within two range_sigma; and their
/// number.
struct RangeTrust {
  int count = 0;
  double share_within_2_sigma = 0;
};
RangeTrust measure_range_trust(const Truth& truth, const Detections& detections, double min_score);

}  // namespace bole
