#include "detect/trunk_finder.h"

#include <algorithm>
#include <cmath>

namespace bole {
namespace {

constexpr float kWorthOtherFeet = -6.0F;  // logit: with a wrong foot a trunk looks like none
constexpr float kWorthAnswering = -3.5F;  // logit
constexpr float kFarBetter = 3.0F;        // of two logits: the second look seldom turns them round
constexpr float kSure = 4.0F;             // logit
constexpr float kHopeless = -99;          // logit

// The farther the search goes, the more trunks there are.
int most_candidates(const Search& search) {
  return static_cast<int>(std::clamp(250 + 27 * (search.range.high - 8), 250.0, 1100.0));
}

}  // namespace

TrunkFinder::TrunkFinder(const DetectorSetup& setup)
    : columns_(setup.panorama.columns),
      wraps_(setup.panorama.wraps()),
      focal_(setup.panorama.focal()),
      bands_(setup, Templates::margin(setup)),
      templates_(setup, bands_, most_candidates(setup.search)),
      fitter_(setup),
      reader_(setup) {
  sights_.reserve(most_candidates(setup.search));
  trunks_.reserve(3 * most_candidates(setup.search));
  kept_.reserve(3 * most_candidates(setup.search));
}

std::span<const Candidate> TrunkFinder::candidates(const PanoramaView& panorama) {
  bands_.compute(panorama);
  return templates_.find(bands_);
}

// Whether there is anything above the foot, and the widest row of cells about this outline lies
// within the bands from top to bottom.
bool TrunkFinder::readable(const TrunkShape& shape) const {
  const float beside = 1.6F * shape.width() + 4;
  const float bottom = static_cast<float>(bands_.count() * Bands::kRows);
  const auto inside = [&](float row) {
    const float middle = shape.centre() + shape.slope() * (row - shape.foot);
    return middle - beside > static_cast<float>(-bands_.margin()) &&
           middle + beside < static_cast<float>(bands_.width() + bands_.margin());
  };
  return shape.width() > 0 && shape.foot >= 2 * Bands::kRows && inside(0) && inside(bottom);
}

bool TrunkFinder::read(const PanoramaView& panorama, const TrunkShape& shape, const EdgeFit& fit,
                       TrunkFeatures::Values& out) const {
  if (!readable(shape)) return false;
  reader_.read(bands_, panorama, shape, fit, fitter_.first_band(shape.left, shape.right), out);
  return true;
}

// Most candidates about a trunk are that trunk seen amiss: those that look best go first, and what
// one of them explains far better is not looked at again.
std::span<Trunk> TrunkFinder::find(const PanoramaView& panorama) {
  sights_.clear();
  for (const Candidate& candidate : candidates(panorama)) {
    Sight sight;
    if (fit(candidate, sight.trunk.shape, sight.trunk.fit)) sights_.push_back(sight);
  }
  judge(panorama, sights_);
  std::erase_if(sights_, [](const Sight& s) { return s.judgement.logit < kWorthOtherFeet; });
  std::sort(sights_.begin(), sights_.end(), [](const Sight& a, const Sight& b) {
    return a.judgement.logit != b.judgement.logit ? a.judgement.logit > b.judgement.logit
                                                  : a.trunk.shape.left < b.trunk.shape.left;
  });
  trunks_.clear();
  for (const Sight& sight : sights_) {
    if (explained(sight.trunk.shape, sight.judgement.logit + kFarBetter)) continue;
    look_again(panorama, sight);
    if (!explained(sight.trunk.shape, kSure)) look_at_other_feet(panorama, sight);
  }
  suppress();
  return kept_;
}

// Some at a time: the network's weights are read once for all of them.
void TrunkFinder::judge(const PanoramaView& panorama, std::span<Sight> sights) const {
  constexpr std::size_t kAtOnce = 8;
  std::array<TrunkFeatures::Values, kAtOnce> features;
  std::array<Judgement, kAtOnce> judgements;
  std::array<Sight*, kAtOnce> seen;
  std::size_t count = 0;
  const auto judge_seen = [&] {
    bole::judge(std::span(features).first(count), judgements);
    for (std::size_t i = 0; i < count; ++i) seen[i]->judgement = judgements[i];
    count = 0;
  };
  for (Sight& sight : sights) {
    sight.judgement = {.logit = kHopeless};
    if (!read(panorama, sight.trunk.shape, sight.trunk.fit, features[count])) continue;
    seen[count++] = &sight;
    if (count == kAtOnce) judge_seen();
  }
  judge_seen();
}

// A second look, from where the first one says that the trunk is.
void TrunkFinder::look_again(const PanoramaView& panorama, Sight sight) {
  if (sight.judgement.logit < kWorthASecondLook) return;
  Trunk& trunk = sight.trunk;
  trunk.shape = corrected(trunk.shape, sight.judgement, focal_);
  if (!readable(trunk.shape)) return;
  refine(trunk.shape, trunk.fit);
  judge(panorama, std::span(&sight, 1));
  const Judgement& judgement = sight.judgement;
  if (judgement.logit < kWorthAnswering || trunks_.size() == trunks_.capacity()) return;
  const float width = trunk.shape.width(), unit = foot_unit(trunk.shape, focal_);
  trunk.shape = corrected(trunk.shape, judgement, focal_);
  trunk.logit = judgement.logit;
  trunk.centre_sigma = width * std::exp(judgement.log_sigma[0]);
  trunk.width_sigma = std::exp(judgement.log_sigma[1]);
  trunk.foot_sigma = unit * std::exp(judgement.log_sigma[2]);
  trunk.cut = trunk.shape.foot + trunk.foot_sigma + Bands::kRows > last_row(trunk.shape.centre());
  trunks_.push_back(trunk);
}

void TrunkFinder::look_at_other_feet(const PanoramaView& panorama, const Sight& sight) {
  std::array<float, EdgeFitter::kOtherFeet> feet;
  const int count = other_feet(sight.trunk.shape, feet);
  std::array<Sight, EdgeFitter::kOtherFeet> others;
  for (int i = 0; i < count; ++i) {
    others[i] = sight;
    others[i].trunk.shape = ended_at(sight.trunk.shape, feet[i]);
  }
  const auto all = std::span(others).first(static_cast<std::size_t>(count));
  judge(panorama, all);
  for (const Sight& other : all) {
    if (!explained(other.trunk.shape, other.judgement.logit + kFarBetter))
      look_again(panorama, other);
  }
}

// Whether a trunk of a higher logit explains the same pixels.
bool TrunkFinder::explained(const TrunkShape& shape, float logit) const {
  return std::any_of(trunks_.begin(), trunks_.end(), [&](const Trunk& trunk) {
    return trunk.logit > logit && same_pixels(trunk.shape, shape);
  });
}

// Whether two outlines explain the same picture: one covers most of the other, or they take one
// edge from its two sides.
bool TrunkFinder::same_pixels(const TrunkShape& a, const TrunkShape& b) const {
  const float row = std::min(a.foot, b.foot);
  const auto left = [&](const TrunkShape& s) { return s.left + s.slope() * (row - s.foot); };
  const float turn = static_cast<float>(columns_);
  // Whole turns between them; std::round would be a call.
  constexpr float kMany = 16;
  const float turns = (a.centre() - b.centre()) / turn + (kMany + 0.5F);
  const float shift = wraps_ ? turn * (static_cast<float>(static_cast<int>(turns)) - kMany) : 0;
  const float a0 = left(a), a1 = a0 + a.width(), b0 = left(b) + shift, b1 = b0 + b.width();
  const float narrower = std::min(a.width(), b.width());
  if (std::min(a1, b1) - std::max(a0, b0) > 0.5F * narrower) return true;
  const float near = std::max(1.5F, 0.2F * narrower);
  return a.dark != b.dark && (std::abs(a0 - b1) < near || std::abs(a1 - b0) < near);
}

void TrunkFinder::suppress() {
  std::sort(trunks_.begin(), trunks_.end(), [](const Trunk& a, const Trunk& b) {
    return a.logit != b.logit ? a.logit > b.logit : a.shape.left < b.shape.left;
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
