#pragma once

#include <vector>

#include "detect/detector.h"
#include "detect/paper/paper_candidates.h"
#include "detect/paper/paper_scores.h"

namespace bole {

/// Lu and Rasmussen, "Tree trunk detection using contrast templates", as it stands: bar filters of
/// five widths at each whole metre, summed from the foot's row to the top, local minima below -4,
/// non-maximum suppression along the row, then down the column. Trees carry
/// score = 1 - exp(S / 8); their sigmas are those of the steps in depth, width and column. Looks
/// nowhere else where trunks are expected.
class PaperDetector final : public Detector {
 public:
  /// Throws ConfigError when the searched trees do not fit the panorama.
  explicit PaperDetector(const DetectorSetup& setup);

 private:
  std::span<const Tree> find(const PanoramaView& panorama,
                             std::span<const ExpectedTrunk> expected) override;
  Tree tree_of(const PaperCandidate& candidate) const;

  DetectorSetup setup_;
  PaperScores scores_;
  std::vector<PaperCandidate> candidates_;
  std::vector<Tree> trees_;
};

}  // namespace bole
