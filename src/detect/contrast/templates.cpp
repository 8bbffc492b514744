#include "detect/contrast/templates.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "detect/contrast/template_kernels.h"
#include "detect/range_posterior.h"
#include "detect/rounding.h"
#include "geometry/ground.h"

namespace bole {
namespace {

constexpr double kContrast = 0.20;  // of log brightness: full contrast
constexpr int kLeastEvidence = 96;  // of a candidate
constexpr double kWidthStep = 1.15;
constexpr double kNarrowest = 4;     // columns
constexpr int kWidestFlank = 28;     // columns
constexpr int kWidestStep = 4;       // columns from one left edge to the next
constexpr double kSlope = 0.30;      // rising ground shifts feet by up to this tangent
constexpr double kHeldBack = -0.4;   // power of the width: wide templates gather more from nothing
constexpr double kFootSigma = 0.10;  // tangent, of the foot that evidence ends at
constexpr double kPlaceCounts = 0.27;   // power of its likelihood
constexpr double kUsualShare = 0.53;    // of the searched range, where most trees are found
constexpr double kRangeSpread = 1.31;   // standard deviation about that, of the range's logarithm
constexpr double kLeastTangent = 0.03;  // of a foot: nearer the horizon all are as far away
// Found are some hundreds; the widest, which come last, go first where noise gives more.
constexpr std::size_t kMostFound = 20000;
constexpr double kLikely = 0.15;  // logarithm: from so much below 0 on a place counts

// To the nearest whole number; columns stay far from the limits.
int rounded(double x) { return static_cast<int>(x + (kFar + 0.5)) - static_cast<int>(kFar); }

// How near the centres of twins are at most, by the width of the narrower one.
float near_twin(float width) { return std::max(1.5F, 0.15F * width); }

int widest_template(const DetectorSetup& setup) {
  const double widest =
      std::min(1.3, angular_width(setup.search.diameter.high * 1.1, setup.search.range.low * 0.95));
  return static_cast<int>(std::ceil(widest * setup.panorama.focal()));
}

}  // namespace

int Templates::margin(const DetectorSetup& setup) {
  return widest_template(setup) * 3 / 2 + 4 * kTemplateChunk + 48;
}

Templates::Templates(const DetectorSetup& setup, const Bands& bands, int most_candidates)
    : columns_(setup.panorama.columns),
      width_(setup.panorama.width),
      bands_(setup.panorama.rows / Bands::kRows),
      widest_(widest_template(setup)),
      pad_(widest_ / 16 + 16),
      most_(most_candidates),
      wraps_(setup.panorama.wraps()),
      focal_(setup.panorama.focal()) {
  const double horizon = setup.panorama.horizon_row() + 0.5;
  horizon_band_ = std::clamp(static_cast<int>(std::lround(horizon / Bands::kRows)), 0, bands_);
  const auto band_of_tangent = [&](double down) {
    return std::clamp((horizon + focal_ * down) / Bands::kRows, 0.0, static_cast<double>(bands_));
  };

  for (const int width : {2, 3, 5, 8, 12, 16, kWidestFlank}) add_flank(bands, width);
  const Search& search = setup.search;
  const RangePosterior posterior(setup.height, search);
  const double narrowest =
      std::max(kNarrowest, 0.85 * focal_ * angular_width(search.diameter.low, search.range.high));
  int last = 0;
  const int steps =
      static_cast<int>(std::ceil(std::log(widest_ / narrowest) / std::log(kWidthStep)));
  for (int i = 0; i < steps; ++i) {
    const double w = narrowest * std::pow(kWidthStep, i);
    Size size;
    const auto nearest = [&](double k) {
      return [k](const Flank& a, const Flank& b) {
        return std::abs(std::log(a.width / k)) < std::abs(std::log(b.width / k));
      };
    };
    size.flank = static_cast<int>(
        std::min_element(flanks_.begin(), flanks_.end(), nearest(std::max(2.0, 0.33 * w))) -
        flanks_.begin());
    const int step = flanks_[size.flank].step;
    size.width = std::max(1, static_cast<int>(std::lround(w / step))) * step;
    if (size.width <= last) continue;
    last = size.width;
    // The ground where a trunk of this angular width and a searched diameter can stand.
    const double s = std::sin(std::min(1.4, size.width / focal_) / 2);
    // Thinner trees nearer by are looked for, too, or they would be taken for searched ones beyond.
    const double nearest_range = std::max(0.6 * search.diameter.low / (2 * s), search.range.low);
    const double down = setup.height / std::max(0.5 * nearest_range, nearest_range * (1 - s));
    size.first_foot = static_cast<int>(band_of_tangent(-kSlope));
    size.last_foot = static_cast<int>(std::ceil(band_of_tangent(1.15 * down + 0.05)));
    if (size.last_foot <= size.first_foot) continue;
    weigh_feet(setup, posterior, size);
    sizes_.push_back(std::move(size));
  }
  for (auto& peaks : peaks_) {
    peaks.resize(sizes_.size());
    for (std::size_t i = 0; i < sizes_.size(); ++i) {
      const int n = width_ / flanks_[sizes_[i].flank].step + kTemplateChunk;
      peaks[i].evidence.resize(n + 2 * pad_);
      peaks[i].foot.resize(n);
    }
  }
  thinned_.resize(static_cast<std::size_t>(bands_) * thinned_pitch(2));
  places_.resize(width_);
  found_.reserve(kMostFound);
  kept_.reserve(most_);
  earlier_in_part_.reserve(most_);
}

// How much the place of a foot counts in a candidate's rank, by the band that the trunk ends in:
// more where searched trees are likely to end on level ground, and where they are found rather than
// at the horizon, at which the contrasts of all the wood behind end. Nowhere does it count against
// a candidate: under a tilt feet are elsewhere, and trees that are not searched tell of the tilt.
void Templates::weigh_feet(const DetectorSetup& setup, const RangePosterior& posterior,
                           Size& size) const {
  const double usual = kUsualShare * setup.search.range.high;
  const double held_back = std::pow(size.width, kHeldBack);
  for (int band = 0; band < bands_; ++band) {
    const double down = -setup.panorama.tangent_of_row((band + 1) * Bands::kRows - 0.5);
    const double likelihood = posterior.log_likelihood_of_searched(
        {.down = down, .down_sigma = kFootSigma, .angular_width = size.width / focal_});
    const double off =
        std::log(setup.height / (std::max(down, kLeastTangent) * usual)) / kRangeSpread;
    const double place = kLikely + kPlaceCounts * likelihood - 0.5 * off * off;
    size.rank_factors.push_back(held_back * std::exp(std::max(place, 0.0)));
  }
}

void Templates::add_flank(const Bands& bands, int width) {
  static_assert(kWidestFlank <= Bands::kMostFlank);
  const int step = width >= 12 ? kWidestStep : width >= 8 ? 2 : 1;
  Flank flank{.width = width,
              .step = step,
              .pitch = (width_ + widest_ + 8) / step + 2 * kTemplateChunk,
              .unseen = {}};
  flank.count = std::min(flank.pitch - kTemplateChunk,
                         (width_ + bands.margin() - width) / step - kTemplateChunk);
  for (int band = 0; band < bands_; ++band) {
    const std::uint8_t* seen = bands.seen(band);
    for (int i = 0; i < flank.count; ++i) {
      const int x = i * step;
      if (seen[x - width] & seen[x - 1] & seen[x] & seen[x + width - 1]) continue;
      if (!flank.unseen.empty() && flank.unseen.back().band == band &&
          flank.unseen.back().last == i) {
        ++flank.unseen.back().last;
      } else {
        flank.unseen.push_back({band, i, i + 1});
      }
    }
  }
  const auto make_room = [&](std::vector<std::uint8_t>& responses, int rows) {
    responses.resize(std::max(responses.size(), static_cast<std::size_t>(rows) * flank.pitch));
  };
  make_room(responses_, bands_);
  make_room(rising_, horizon_band_);
  make_room(falling_, horizon_band_);
  flanks_.push_back(std::move(flank));
}

int Templates::thinned_pitch(int step) const {
  return (width_ + widest_ + 3 * kWidestFlank) / step + 2 * kTemplateChunk;
}

// Keeps every so many of a band's sums, from kWidestFlank columns before the first one on.
void Templates::thin(const Bands& bands, int step) {
  static_assert(kWidestFlank % kWidestStep == 0);
  const int pitch = thinned_pitch(step);
  for (int band = 0; band < bands_; ++band) {
    thin_sums(bands.sum(band) - kWidestFlank, step, pitch - kTemplateChunk,
              thinned_.data() + static_cast<std::ptrdiff_t>(band) * pitch);
  }
}

const std::uint16_t* Templates::sums_of(const Bands& bands, int band, int step) const {
  if (step == 1) return bands.sum(band);
  return thinned_.data() + static_cast<std::ptrdiff_t>(band) * thinned_pitch(step) +
         kWidestFlank / step;
}

void Templates::respond(const Bands& bands, const Flank& flank) {
  const auto factor = static_cast<std::int16_t>(
      std::lround(32768 * kFullResponse / (kContrast * Bands::kScale * flank.width)));
  const int wide = flank.width / flank.step;
  for (int band = 0; band < bands_; ++band) {
    const std::uint16_t* const sums = sums_of(bands, band, flank.step);
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(band) * flank.pitch;
    if (band < horizon_band_) {
      edge_responses_above(sums, wide, factor, flank.count,
                           {.right_sign = responses_.data() + at,
                            .either_sign = {rising_.data() + at, falling_.data() + at}});
    } else {
      edge_responses(sums, wide, factor, flank.count, responses_.data() + at);
    }
  }
  for (const Unseen& run : flank.unseen) {
    const auto forget = [&](std::vector<std::uint8_t>& responses) {
      const auto row = responses.begin() + static_cast<std::ptrdiff_t>(run.band) * flank.pitch;
      std::fill(row + run.first, row + run.last, std::uint8_t{kNoResponse});
    };
    forget(responses_);
    if (run.band >= horizon_band_) continue;
    forget(rising_);
    forget(falling_);
  }
}

void Templates::accumulate(int size_index) {
  const Size& size = sizes_[size_index];
  const Flank& flank = flanks_[size.flank];
  EvidenceSums sums{.responses = responses_.data(),
                    .either_sign = {rising_.data(), falling_.data()},
                    .pitch = flank.pitch,
                    .across = size.width / flank.step,
                    .horizon = horizon_band_,
                    .first_foot = size.first_foot,
                    .last_foot = size.last_foot,
                    .count = width_ / flank.step};
  for (const int polarity : {0, 1}) {
    sums.evidence[polarity] = peaks_[polarity][size_index].evidence.data() + pad_;
    sums.foot[polarity] = peaks_[polarity][size_index].foot.data();
  }
  sum_evidence(sums);
  for (const int polarity : {0, 1}) pad(sums.evidence[polarity], sums.count);
}

// What lies beyond the borders: the other side of the turn, or nothing.
void Templates::pad(std::int16_t* evidence, int count) const {
  for (int i = 0; i < pad_; ++i) {
    evidence[-1 - i] = wraps_ ? evidence[count - 1 - i] : std::int16_t{-1};
    evidence[count + i] = wraps_ ? evidence[i] : std::int16_t{-1};
  }
}

// Templates of another size about the same centres as those of `size`; none beyond the sizes.
Templates::Neighbour Templates::neighbour(int size_index, int polarity, const Size& size) const {
  if (size_index < 0 || size_index >= static_cast<int>(sizes_.size())) return {};
  const Size& other = sizes_[size_index];
  const int step = flanks_[other.flank].step;
  return {.evidence = peaks_[polarity][size_index].evidence.data() + pad_,
          .offset = size.width - other.width + step,
          .shift = std::countr_zero(static_cast<unsigned>(2 * step))};
}

// Whether the template nearest to the same centre, or one beside it, has more evidence.
bool Templates::Neighbour::beats(int left, int evidence_there) const {
  if (!evidence) return false;
  const std::int16_t* at = evidence + ((2 * left + offset) >> shift);
  return std::max({at[-1], at[0], at[1]}) > evidence_there;
}

void Templates::collect(int size_index, int polarity) {
  const Size& size = sizes_[size_index];
  const Peaks& peaks = peaks_[polarity][size_index];
  const int step = flanks_[size.flank].step;
  const int reach = std::max(1, static_cast<int>(0.15 * size.width) / step);
  const std::int16_t* at = peaks.evidence.data() + pad_;
  const int count = find_peaks(at, width_ / step, kLeastEvidence, reach, places_.data());
  const Neighbour narrower = neighbour(size_index - 1, polarity, size);
  const Neighbour wider = neighbour(size_index + 1, polarity, size);
  for (const int i : std::span(places_).first(count)) {
    const int evidence = at[i];
    if (narrower.beats(i * step, evidence) || wider.beats(i * step, evidence)) continue;
    if (found_.size() == kMostFound) return;
    found_.push_back({static_cast<float>(i * step), static_cast<float>(size.width),
                      static_cast<float>(peaks.foot[i] * Bands::kRows), polarity == 0,
                      static_cast<float>(evidence * size.rank_factors[peaks.foot[i] - 1])});
  }
}

// Which part of the turn a column lies in; parts beyond a turn are the first ones again.
int Templates::part_of(float column) const {
  return rounded(column * kParts / static_cast<float>(columns_));
}

// Whether a candidate that is kept is nearly the same.
bool Templates::has_twin(const Candidate& c) const {
  const float centre = c.left + 0.5F * c.width, near = near_twin(c.width);
  const auto is_twin = [&](const Candidate& k) {
    const float tolerance = std::min(near, near_twin(k.width));
    float shift = std::abs(centre - k.left - 0.5F * k.width);
    if (wraps_) shift = std::min(shift, static_cast<float>(columns_) - shift);
    return c.dark == k.dark && shift < tolerance && std::abs(c.width - k.width) < 2 * tolerance &&
           std::abs(c.foot - k.foot) < std::max(8.0F, 0.35F * c.width);
  };
  for (int part = part_of(centre - near); part <= part_of(centre + near); ++part) {
    for (int k = latest_in_part_[(part + kParts) % kParts]; k >= 0; k = earlier_in_part_[k])
      if (is_twin(kept_[k])) return true;
  }
  return false;
}

// Keeps the most evident; of near twins only the better.
void Templates::thin_out() {
  // Few of them are wanted: a heap gives them in order without sorting the rest.
  const auto comes_later = [](const Candidate& a, const Candidate& b) {
    return a.rank != b.rank   ? a.rank < b.rank
           : a.left != b.left ? a.left > b.left
                              : a.width > b.width;
  };
  std::make_heap(found_.begin(), found_.end(), comes_later);
  kept_.clear();
  earlier_in_part_.clear();
  latest_in_part_.fill(-1);
  for (auto end = found_.end(); end != found_.begin() && kept_.size() < most_; --end) {
    std::pop_heap(found_.begin(), end, comes_later);
    const Candidate& c = *(end - 1);
    if (has_twin(c)) continue;
    int& latest = latest_in_part_[part_of(c.left + 0.5F * c.width) % kParts];
    earlier_in_part_.push_back(std::exchange(latest, static_cast<int>(kept_.size())));
    kept_.push_back(c);
  }
}

std::span<const Candidate> Templates::find(const Bands& bands) {
  // Sizes of the same flank follow each other, and flanks of the same step.
  int responded = -1, step = 1;
  for (int i = 0; i < static_cast<int>(sizes_.size()); ++i) {
    const int index = sizes_[i].flank;
    const Flank& flank = flanks_[index];
    if (flank.step != step) thin(bands, flank.step);
    if (index != responded) respond(bands, flank);
    step = flank.step;
    responded = index;
    accumulate(i);
  }
  found_.clear();
  for (int i = 0; i < static_cast<int>(sizes_.size()); ++i)
    for (const int polarity : {0, 1}) collect(i, polarity);
  thin_out();
  return kept_;
}

}  // namespace bole
