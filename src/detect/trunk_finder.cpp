#include "detect/trunk_finder.h"

#include <algorithm>
#include <cmath>

namespace bole {
namespace {

constexpr float kWorthASecondLook = -3.0F;  // logit
constexpr float kWorthOtherFeet = -4.0F;    // logit
constexpr float kWorthAnswering = -3.5F;    // logit

// The farther the search goes, the more trunks there are.
int most_candidates(const Search& search) {
  return static_cast<int>(std::clamp(140 + 27 * (search.range.high - 8), 140.0, 1000.0));
}

}  // namespace

TrunkFinder::TrunkFinder(const DetectorSetup& setup)
    : columns_(setup.panorama.columns),
      wraps_(setup.panorama.wraps()),
      focal_(setup.panorama.focal()),
      bands_(setup, Templates::margin(setup)),
      templates_(setup, most_candidates(setup.search)),
      fitter_(setup),
      reader_(setup) {
  trunks_.reserve(3 * most_candidates(setup.search));
  kept_.reserve(3 * most_candidates(setup.search));
}

std::span<const Candidate> TrunkFinder::candidates(const PanoramaView& panorama) {
  bands_.compute(panorama);
  return templates_.find(bands_);
}

void TrunkFinder::read(const PanoramaView& panorama, const TrunkShape& shape, const EdgeFit& fit,
                       float evidence, TrunkFeatures::Values& out) const {
  reader_.read(bands_, panorama, shape, fit, evidence, fitter_.first_band(shape.left, shape.right),
               out);
}

std::span<Trunk> TrunkFinder::find(const PanoramaView& panorama) {
  trunks_.clear();
  for (const Candidate& candidate : candidates(panorama)) {
    Trunk trunk;
    if (!fit(candidate, trunk.shape, trunk.fit)) continue;
    if (look(panorama, trunk, candidate.evidence) < kWorthOtherFeet) continue;
    std::array<float, EdgeFitter::kOtherFeet> feet;
    const int count = other_feet(trunk.shape, feet);
    for (int i = 0; i < count; ++i) {
      Trunk other = trunk;
      other.shape = ended_at(trunk.shape, feet[i]);
      look(panorama, other, candidate.evidence);
    }
  }
  suppress();
  return kept_;
}

// Judges a trunk; returns the logit at first sight.
float TrunkFinder::look(const PanoramaView& panorama, Trunk trunk, float evidence) {
  TrunkFeatures::Values features;
  read(panorama, trunk.shape, trunk.fit, evidence, features);
  Judgement judgement = judge(features);
  const float at_first_sight = judgement.logit;
  if (at_first_sight < kWorthASecondLook) return at_first_sight;

  // A second look from where the first one says that the trunk is.
  trunk.shape = corrected(trunk.shape, judgement, focal_);
  refine(trunk.shape, trunk.fit);
  read(panorama, trunk.shape, trunk.fit, evidence, features);
  judgement = judge(features);
  if (judgement.logit < kWorthAnswering || trunks_.size() == trunks_.capacity())
    return at_first_sight;
  const float width = trunk.shape.width(), unit = foot_unit(trunk.shape, focal_);
  trunk.shape = corrected(trunk.shape, judgement, focal_);
  trunk.probability = 1 / (1 + std::exp(-judgement.logit));
  trunk.centre_sigma = width * std::exp(judgement.log_sigma[0]);
  trunk.width_sigma = std::exp(judgement.log_sigma[1]);
  trunk.foot_sigma = unit * std::exp(judgement.log_sigma[2]);
  trunks_.push_back(trunk);
  return at_first_sight;
}

// Whether two outlines explain the same picture: one covers most of the other, or they take one
// edge from its two sides.
bool TrunkFinder::same_pixels(const TrunkShape& a, const TrunkShape& b) const {
  const float row = std::min(a.foot, b.foot);
  const auto left = [&](const TrunkShape& s) { return s.left + s.slope() * (row - s.foot); };
  const float turn = static_cast<float>(columns_);
  float shift = wraps_ ? turn * std::round((a.centre() - b.centre()) / turn) : 0;
  const float a0 = left(a), a1 = a0 + a.width(), b0 = left(b) + shift, b1 = b0 + b.width();
  const float narrower = std::min(a.width(), b.width());
  if (std::min(a1, b1) - std::max(a0, b0) > 0.5F * narrower) return true;
  const float near = std::max(1.5F, 0.2F * narrower);
  return a.dark != b.dark && (std::abs(a0 - b1) < near || std::abs(a1 - b0) < near);
}

void TrunkFinder::suppress() {
  std::sort(trunks_.begin(), trunks_.end(), [](const Trunk& a, const Trunk& b) {
    return a.probability != b.probability ? a.probability > b.probability
                                          : a.shape.left < b.shape.left;
  });
  kept_.clear();
  for (const Trunk& trunk : trunks_) {
    const bool explained = std::any_of(kept_.begin(), kept_.end(), [&](const Trunk& k) {
      return same_pixels(k.shape, trunk.shape);
    });
    if (!explained) kept_.push_back(trunk);
  }
}

}  // namespace bole
