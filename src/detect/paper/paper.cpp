#include "detect/paper/paper.h"

#include <cmath>

#include "geometry/angles.h"

namespace bole {
namespace {

constexpr float kThreshold = -4;  // the paper's alpha
constexpr float kScoreScale = 8;  // S at which the score is 1 - 1/e

}  // namespace

PaperDetector::PaperDetector(const DetectorSetup& setup)
    : setup_(setup),
      scores_(setup.panorama, paper_templates(setup.panorama, setup.height, setup.search)) {
  // Every other column of every template: more minima there cannot be.
  const std::size_t most = scores_.templates().size() * (setup.panorama.width / 2 + 1);
  candidates_.reserve(most);
  trees_.reserve(most);
}

std::span<const Tree> PaperDetector::find(const PanoramaView& panorama,
                                          std::span<const ExpectedTrunk> /*expected*/) {
  ColumnSums& rows = scores_.rows();
  rows.begin();
  rows.add_rows(panorama.pixels, panorama.stride, setup_.panorama.rows);
  rows.end();

  candidates_.clear();
  for (std::size_t k = 0; k < scores_.templates().size(); ++k) {
    append_minima(scores_.scores(k), kThreshold, setup_.panorama.wraps(), static_cast<int>(k),
                  candidates_);
  }
  std::erase_if(candidates_,
                [&](const PaperCandidate& c) { return setup_.seen.columns[c.column].empty(); });
  suppress(scores_.templates(), setup_.panorama.wraps() ? setup_.panorama.width : 0, candidates_);

  trees_.clear();
  for (const PaperCandidate& candidate : candidates_) trees_.push_back(tree_of(candidate));
  return trees_;
}

Tree PaperDetector::tree_of(const PaperCandidate& candidate) const {
  const PaperTemplate& t = scores_.templates()[candidate.index];
  const double step = 1 / std::sqrt(12.0);  // standard deviation of what is rounded to whole steps
  const Search& search = setup_.search;
  return {
      .bearing = static_cast<float>(setup_.panorama.bearing_of_column(candidate.column)),
      .range = static_cast<float>(t.range()),
      .diameter = static_cast<float>(t.diameter),
      .score = 1 - std::exp(candidate.score / kScoreScale),
      .bearing_sigma = static_cast<float>(step / setup_.panorama.focal()),
      .range_sigma = static_cast<float>(step),
      .diameter_sigma = static_cast<float>(step * (search.diameter.high - search.diameter.low) / 4),
      .base_elevation = static_cast<float>(std::atan2(-setup_.height, t.foot_distance)),
      .angular_width = static_cast<float>(t.angular_width)};
}

}  // namespace bole
