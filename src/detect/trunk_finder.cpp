#include "detect/trunk_finder.h"

#include <algorithm>
#include <cmath>

#include "detect/network/close_look.h"
#include "detect/network/dense_layer.h"
#include "detect/network/last_look.h"
#include "geometry/ground.h"

namespace bole {
namespace {

constexpr float kWorthAnswering = -3.5F;  // logit
constexpr float kWorthLocating = -2.0F;   // logit
constexpr float kFarBetter = 3.0F;        // of two logits: the second look seldom turns them round
constexpr float kSure = 2.0F;             // logit
constexpr float kExpectation = 2.0F;      // logit that rivals must be better by
constexpr float kMostHidden = 0.6F;       // of a trunk's width, behind another one
constexpr float kHopeless = -99;          // logit
constexpr double kNarrower = 0.8;         // than any that is searched for, it may still be one
constexpr double kFarther = 1.6;          // likewise, of where it stands on level ground
constexpr double kLocatedFarther = 1.25;  // likewise, of what is worth a last look

// Bounds of a frame's time, which dense woods searched to 40 m reach.
constexpr int kMostSecondLooks = 500;         // of candidates, and again of other feet
constexpr std::size_t kMostOtherFeet = 2000;  // that are glanced at

// Of a foot on level ground so many times as far away as is searched.
float foot_row(const DetectorSetup& setup, double farther) {
  const double tangent = ground_tangent(farther * setup.search.range.high, setup.height);
  return static_cast<float>(setup.panorama.row_of_tangent(tangent) + 0.5);
}

}  // namespace

Effort Effort::for_reach(double range) {
  constexpr double kShort = 8, kLong = 40;  // metres
  const double far = std::clamp((range - kShort) / (kLong - kShort), 0.0, 1.0);
  const auto between = [far](double low, double high) { return low + far * (high - low); };
  return {.candidates = static_cast<int>(between(130, 1400)),
          .close_looks = static_cast<int>(between(5, 150)),
          .last_looks = static_cast<int>(between(16, 150)),
          .worth_other_feet = static_cast<float>(between(-5, -7.5)),
          .worth_a_second_look = static_cast<float>(between(-3, -5)),
          .doubt = static_cast<float>(between(2, 3.5))};
}

TrunkFinder::TrunkFinder(const DetectorSetup& setup)
    : columns_(setup.panorama.columns),
      wraps_(setup.panorama.wraps()),
      focal_(setup.panorama.focal()),
      narrowest_(static_cast<float>(
          kNarrower * focal_ * angular_width(setup.search.diameter.low, setup.search.range.high))),
      highest_foot_(foot_row(setup, kFarther)),
      highest_located_(foot_row(setup, kLocatedFarther)),
      effort_(Effort::for_reach(setup.search.range.high)),
      bands_(setup, std::max(Templates::margin(setup), patch_reach(focal_))),
      templates_(setup, bands_, effort_.candidates),
      fitter_(setup),
      reader_(setup) {
  sights_.reserve(effort_.candidates);
  others_.reserve(std::min(EdgeFitter::kOtherFeet * sights_.capacity(), kMostOtherFeet));
  trunks_.reserve(std::size_t{3} * effort_.candidates);
  kept_.reserve(trunks_.capacity());
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

bool TrunkFinder::glance(const TrunkShape& shape, const EdgeFit& fit,
                         TrunkFeatures::Values& out) const {
  if (!readable(shape)) return false;
  reader_.glance(bands_, shape, fit, fitter_.first_band(shape.left, shape.right), out);
  return true;
}

TrunkPatches TrunkFinder::patches(const TrunkShape& shape) const {
  // To where its middle lies within the panorama: half a turn from the middle at most.
  const float shift = whole_turns(shape.centre() - 0.5F * static_cast<float>(columns_));
  TrunkShape within = shape;
  within.left -= shift;
  within.right -= shift;
  return read_patches(bands_, within, fitter_.first_band(shape.left, shape.right), focal_);
}

// Most candidates about a trunk are that trunk seen amiss: those that look best go first, and what
// one of them explains far better is not looked at again.
std::span<Trunk> TrunkFinder::find(const PanoramaView& panorama,
                                   std::span<const Candidate> expected) {
  sights_.clear();
  for (const Candidate& candidate : candidates(panorama)) {
    Sight sight;
    if (fit(candidate, sight.trunk.shape, sight.trunk.fit)) sights_.push_back(sight);
  }
  glance(sights_);
  keep_best(sights_, effort_.worth_other_feet);
  trunks_.clear();
  look_again(panorama, sights_);
  look_at_other_feet(panorama);
  look_where_expected(panorama, expected);
  suppress(panorama);
  look_last(panorama);
  return kept_;
}

// Drops what a first look has found less than worth a thought, and sorts the others.
void TrunkFinder::keep_best(std::vector<Sight>& sights, float least) {
  std::erase_if(sights, [least](const Sight& s) { return s.judgement.logit < least; });
  std::sort(sights.begin(), sights.end(), [](const Sight& a, const Sight& b) {
    return a.judgement.logit != b.judgement.logit ? a.judgement.logit > b.judgement.logit
                                                  : a.trunk.shape.left < b.trunk.shape.left;
  });
}

// Some at a time: a network's weights are read once for all of them.
template <class Read, class Judge>
void TrunkFinder::judge_all(std::span<Sight> sights, const Read& read, const Judge& judge) {
  std::array<TrunkFeatures::Values, kLooksAtOnce> features;
  std::array<Judgement, kLooksAtOnce> judgements;
  std::array<Sight*, kLooksAtOnce> seen;
  std::size_t count = 0;
  const auto judge_seen = [&] {
    judge(std::span(features).first(count), judgements);
    for (std::size_t i = 0; i < count; ++i) seen[i]->judgement = judgements[i];
    count = 0;
  };
  for (Sight& sight : sights) {
    sight.judgement = {.logit = kHopeless};
    if (!read(sight.trunk, features[count])) continue;
    seen[count++] = &sight;
    if (count == kLooksAtOnce) judge_seen();
  }
  judge_seen();
}

void TrunkFinder::glance(std::span<Sight> sights) const {
  judge_all(
      sights,
      [&](const Trunk& trunk, TrunkFeatures::Values& features) {
        return glance(trunk.shape, trunk.fit, features);
      },
      judge_at_a_glance);
}

void TrunkFinder::look(const PanoramaView& panorama, std::span<Sight> sights) const {
  judge_all(
      sights,
      [&](const Trunk& trunk, TrunkFeatures::Values& features) {
        return read(panorama, trunk.shape, trunk.fit, features);
      },
      judge);
}

// Second looks, from where the first ones say that the trunks are; some at a time.
void TrunkFinder::look_again(const PanoramaView& panorama, std::span<const Sight> sights) {
  std::array<Sight, kLooksAtOnce> looks;
  std::size_t count = 0;
  const auto judge_looks = [&] {
    const auto all = std::span(looks).first(count);
    look(panorama, all);
    for (const Sight& sight : all) take(sight);
    count = 0;
  };
  int left = kMostSecondLooks;
  for (const Sight& sight : sights) {
    if (sight.judgement.logit < effort_.worth_a_second_look || left == 0) break;
    if (explained(sight.trunk.shape, sight.judgement.logit + kFarBetter)) continue;
    Trunk& trunk = (looks[count] = sight).trunk;
    trunk.shape = corrected(trunk.shape, sight.judgement, focal_);
    if (!readable(trunk.shape)) continue;
    refine(trunk.shape, trunk.fit);
    --left;
    if (++count == kLooksAtOnce) judge_looks();
  }
  judge_looks();
}

// Keeps what a second look does not rule out.
void TrunkFinder::take(const Sight& sight) {
  if (sight.judgement.logit < kWorthAnswering || trunks_.size() == trunks_.capacity()) return;
  trunks_.push_back(sight.trunk);
  settle(trunks_.back(), sight.judgement);
}

// Makes a trunk what a judgement says of it.
void TrunkFinder::settle(Trunk& trunk, const Judgement& judgement) const {
  const float width = trunk.shape.width(), unit = foot_unit(trunk.shape, focal_);
  trunk.shape = corrected(trunk.shape, judgement, focal_);
  trunk.logit = judgement.logit;
  trunk.centre_sigma = width * std::exp(judgement.log_sigma[0]);
  trunk.width_sigma = std::exp(judgement.log_sigma[1]);
  trunk.foot_sigma = unit * std::exp(judgement.log_sigma[2]);
  trunk.cut = trunk.shape.foot + trunk.foot_sigma + Bands::kRows > last_row(trunk.shape.centre());
}

// Two networks that were taught apart err apart: the mean of what they say of the probability is
// better than either. Where the trunk is, the one that sees pixels knows better.
void TrunkFinder::look_closely(const PanoramaView& panorama, Trunk& trunk) const {
  trunk.seen_closely = true;
  TrunkFeatures::Values features;
  if (!read(panorama, trunk.shape, trunk.fit, features)) return;
  Judgement judgement = judge_closely(features, patches(trunk.shape));
  judgement.logit = 0.5F * (judgement.logit + trunk.logit);
  settle(trunk, judgement);
}

// What no sure trunk explains may be one that ends elsewhere: with a wrong foot a good candidate
// looks poor, and what seems better about it may itself be explained away.
void TrunkFinder::look_at_other_feet(const PanoramaView& panorama) {
  others_.clear();
  for (const Sight& sight : sights_) {
    if (explained(sight.trunk.shape, kSure)) continue;
    std::array<float, EdgeFitter::kOtherFeet> feet;
    const int count = other_feet(sight.trunk.shape, feet);
    for (int i = 0; i < count && others_.size() < others_.capacity(); ++i) {
      others_.push_back(sight);
      others_.back().trunk.shape = ended_at(sight.trunk.shape, feet[i]);
    }
  }
  glance(others_);
  keep_best(others_, effort_.worth_a_second_look);
  look_again(panorama, others_);
}

// Once where the edges next to the outline are, and once where it is expected: the edges that stand
// out most may be those of the half of a trunk that is lit.
void TrunkFinder::look_where_expected(const PanoramaView& panorama,
                                      std::span<const Candidate> expected) {
  others_.clear();
  for (const Candidate& candidate : expected) {
    const TrunkShape outline{.foot = candidate.foot,
                             .left = candidate.left,
                             .right = candidate.left + candidate.width,
                             .dark = candidate.dark};
    const bool found = std::any_of(trunks_.begin(), trunks_.end(), [&](const Trunk& trunk) {
      return trunk.logit > kSure && has_outline(trunk.shape, candidate);
    });
    if (found || !readable(outline) || others_.size() + 2 > others_.capacity()) continue;
    Sight sight;
    if (fit(candidate, sight.trunk.shape, sight.trunk.fit)) others_.push_back(sight);
    sight.trunk.shape = outline;
    refine(sight.trunk.shape, sight.trunk.fit);
    others_.push_back(sight);
  }
  look(panorama, others_);
  keep_best(others_, effort_.worth_a_second_look);
  look_again(panorama, others_);
  for (Trunk& trunk : trunks_) {
    trunk.expected = std::any_of(expected.begin(), expected.end(), [&](const Candidate& outline) {
      return has_outline(trunk.shape, outline);
    });
  }
}

// Whether a trunk takes up these columns and ends there: one that ends elsewhere is asked to stand
// up to what is known of its foot.
bool TrunkFinder::has_outline(const TrunkShape& shape, const Candidate& outline) const {
  constexpr float kAside = 0.25F, kOfWidth = 0.25F;  // of the width, of its logarithm
  constexpr float kOfFoot = 1.5F;                    // of foot_unit
  const float middle = shape.centre() + shape.slope() * (outline.foot - shape.foot);
  const float aside = middle - (outline.left + 0.5F * outline.width);
  return std::abs(aside - whole_turns(aside)) < kAside * outline.width &&
         std::abs(std::log(shape.width() / outline.width)) < kOfWidth &&
         std::abs(shape.foot - outline.foot) < kOfFoot * foot_unit(shape, focal_);
}

// What of a distance between columns is whole turns; std::round would be a call.
float TrunkFinder::whole_turns(float columns) const {
  if (!wraps_) return 0;
  constexpr float kMany = 16;
  const float turn = static_cast<float>(columns_);
  const float turns = columns / turn + (kMany + 0.5F);
  return turn * (static_cast<float>(static_cast<int>(turns)) - kMany);
}

// Whether a trunk of a higher logit explains the same pixels.
bool TrunkFinder::explained(const TrunkShape& shape, float logit) const {
  return std::any_of(trunks_.begin(), trunks_.end(), [&](const Trunk& trunk) {
    return trunk.logit > logit && same_pixels(trunk.shape, shape);
  });
}

// Whether two outlines explain the same picture: one covers more of the other than of a tree that
// may be half hidden behind another one, or they take one edge from its two sides.
bool TrunkFinder::same_pixels(const TrunkShape& a, const TrunkShape& b) const {
  const float row = std::min(a.foot, b.foot);
  const auto left = [&](const TrunkShape& s) { return s.left + s.slope() * (row - s.foot); };
  const float shift = whole_turns(a.centre() - b.centre());
  const float a0 = left(a), a1 = a0 + a.width(), b0 = left(b) + shift, b1 = b0 + b.width();
  const float narrower = std::min(a.width(), b.width());
  if (std::min(a1, b1) - std::max(a0, b0) > kMostHidden * narrower) return true;
  const float near = std::max(1.5F, 0.2F * narrower);
  return a.dark != b.dark && (std::abs(a0 - b1) < near || std::abs(a1 - b0) < near);
}

// Of two that are as likely the wider one stays: a lit half looks like a trunk, too. What is known
// of a trunk from earlier frames goes before that. What is in doubt when its turn comes is looked
// at closely, and waits for its turn once more; what that makes surer comes after those that have
// had their turn, all the same.
void TrunkFinder::suppress(const PanoramaView& panorama) {
  const auto rank = [](const Trunk& t) {
    return t.logit + std::log(t.shape.width()) + (t.expected ? kExpectation : 0);
  };
  const auto comes_later = [&](const Trunk& a, const Trunk& b) {
    const float first = rank(a), second = rank(b);
    return first != second ? first < second : a.shape.left > b.shape.left;
  };
  kept_.clear();
  int close_looks = effort_.close_looks;
  std::make_heap(trunks_.begin(), trunks_.end(), comes_later);
  for (auto end = trunks_.end(); end != trunks_.begin();) {
    std::pop_heap(trunks_.begin(), end, comes_later);
    Trunk& trunk = *(end - 1);
    const bool explained = std::any_of(kept_.begin(), kept_.end(), [&](const Trunk& k) {
      return same_pixels(k.shape, trunk.shape);
    });
    if (!explained && close_looks > 0 && in_doubt(trunk)) {
      --close_looks;
      look_closely(panorama, trunk);
      std::push_heap(trunks_.begin(), end, comes_later);
      continue;
    }
    if (!explained) kept_.push_back(trunk);
    --end;
  }
}

// Whether a close look may change what is told of a trunk that may be one of the searched.
bool TrunkFinder::in_doubt(const Trunk& trunk) const {
  return !trunk.seen_closely && std::abs(trunk.logit) < effort_.doubt &&
         trunk.shape.width() > narrowest_ && trunk.shape.foot > highest_foot_;
}

// Where exactly the trunks stand that are likely to be told of.
void TrunkFinder::look_last(const PanoramaView& panorama) {
  TrunkFeatures::Values features;
  int left = effort_.last_looks;
  for (Trunk& trunk : kept_) {
    if (left == 0) return;
    if (trunk.logit < kWorthLocating || trunk.shape.width() < narrowest_ ||
        trunk.shape.foot < highest_located_ || !read(panorama, trunk.shape, trunk.fit, features))
      continue;
    --left;
    Judgement judgement = locate(features, foot_patch(panorama, trunk.shape));
    judgement.logit = trunk.logit;
    settle(trunk, judgement);
  }
}

}  // namespace bole
