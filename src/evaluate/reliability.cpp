#include "evaluate/reliability.h"

#include <algorithm>
#include <cmath>

#include "evaluate/matching.h"

namespace bole {

Reliability measure_reliability(std::span<const Outcome> outcomes) {
  Reliability r;
  for (const Outcome& outcome : outcomes) {
    const int bins = static_cast<int>(r.bins.size());
    Reliability::Bin& bin = r.bins[std::clamp(static_cast<int>(outcome.score * bins), 0, bins - 1)];
    bin.count += 1;
    bin.mean_score += outcome.score;
    bin.hit_share += outcome.hit ? 1 : 0;
  }
  for (Reliability::Bin& bin : r.bins) {
    r.calibration_error += std::abs(bin.hit_share - bin.mean_score);
    bin.mean_score /= std::max(1, bin.count);
    bin.hit_share /= std::max(1, bin.count);
  }
  r.calibration_error /= std::max<double>(1, static_cast<double>(outcomes.size()));
  return r;
}

RangeTrust measure_range_trust(const Truth& truth, const Detections& detections, double min_score) {
  RangeTrust trust;
  int within = 0;
  for (const TruthFrame& frame : truth.frames) {
    const auto found = detections.find(frame.file);
    if (!frame.metric || found == detections.end()) continue;
    for (const Match& match : match_frame(frame, found->second)) {
      if (match.verdict != Match::Verdict::hit || match.tree->score < min_score) continue;
      const double error = std::abs(match.tree->range - *match.truth->range);
      trust.count += 1;
      within += error <= 2 * match.tree->range_sigma ? 1 : 0;
    }
  }
  trust.share_within_2_sigma = static_cast<double>(within) / std::max(1, trust.count);
  return trust;
}

}  // namespace bole
