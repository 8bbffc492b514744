#include "detect/tracking/tracker.h"

#include <algorithm>
#include <cmath>

#include "detect/log_odds.h"
#include "geometry/angles.h"
#include "geometry/ground.h"

namespace bole {
namespace {

// Seconds a tree may stay unseen and keep its id: the longer, the oftener it was seen.
constexpr double kForgetAfter = 0.5, kForgetAfterASighting = 0.5, kForgetAtLast = 5.0;
constexpr double kLookFor = 1.0;  // seconds, where a tree is expected
constexpr int kFewSightings = 3;  // too few to expect it
constexpr double kHardly = 0.1;   // probability of what is not worth expecting
constexpr double kProbable = 0.5;
constexpr std::size_t kMostTracks = 256;
constexpr double kGate = 30.0;         // misfit at which a sighting is no more of a track
constexpr double kAsideGate = 12.0;    // the part of that across the line of sight
constexpr double kWidthSpread = 0.2;   // of log angular width between two sightings of one tree
constexpr double kPartlySeen = 8.0;    // most that a wrong width costs: half a trunk may be lit
constexpr double kPartOfWidth = 0.3;   // that its middle is off by then
constexpr double kScoreSpread = 3.0;   // of a score's log odds between two sightings of one tree
constexpr double kSureEnough = 0.001;  // off 0 or 1: what is surer is as sure
constexpr double kUnlike = 6.0;        // most that an unlikely score costs
constexpr double kJustSeen = 0.3;      // seconds
constexpr double kSamePlace = 0.3;     // of a tree's width
constexpr double kSameWidth = 0.75;    // in kWidthSpread
constexpr double kFartherIfSame = 1.6;
constexpr double kBeyondEdge = 0.15;   // of a tree's width, that a part of it may stand out
constexpr double kNearer = 0.6;        // metres that a part of a tree may seem nearer
constexpr double kWider = 1.2;         // that a whole tree is at least, than a part of it
constexpr double kPartOfRange = 0.05;  // that a range is off by when another foot is found
constexpr double kScaleSeconds = 5.0;  // after which the ranges seen set the scale
constexpr double kScaleSigma = 0.05;   // of the scale as it is
constexpr double kLeastError = 0.03;   // of a range seen, as a share of it

double squared(double x) { return x * x; }

// After longer nothing says how the robot moved.
bool follows(double elapsed) {
  constexpr double kLongestStep = 2.0;  // seconds
  return elapsed >= 0 && elapsed <= kLongestStep;
}

// No two trees this far apart are ever taken for one, however badly their range is known.
double farthest_step(double range) { return std::max(1.0, 0.25 * range); }

// Whether the narrower of two outlines, `turn` apart, lies within the wider one.
bool within(double narrower, double wider, double turn) {
  return turn + narrower / 2 < (0.5 + kBeyondEdge) * wider;
}

// What a sighting may be of a track's tree: a part of it, or the whole where the track is of a
// part.
enum class Share { none, part, whole };
Share share_of(const Track& track, const Tree& tree) {
  const GroundPoint at = track.position();
  const double turn = std::abs(wrap_angle(tree.bearing - std::atan2(at.y, at.x)));
  const double width = angular_width(track.diameter(), track.range());
  const double behind = tree.range - track.range();
  if (within(tree.angular_width, width, turn) && behind > -kNearer &&
      behind < farthest_step(track.range()))
    return Share::part;
  const bool holds = tree.angular_width > kWider * width && within(width, tree.angular_width, turn);
  return holds && std::abs(behind) < kNearer ? Share::whole : Share::none;
}

// A standard deviation that fades from what is known to what may be, by the share `kept`.
double faded(double known, double any, double kept) {
  return std::sqrt(squared(kept * known) + (1 - squared(kept)) * squared(any));
}

}  // namespace

Tracker::Tracker(Scores scores) : scores_(scores) {
  tracks_.reserve(kMostTracks + kMostTrees);
  sightings_.reserve(kMostTrees);
  expected_.reserve(kMostTrees);
  paired_.reserve(kMostTracks + kMostTrees);
  costs_.reserve(kMostTrees * (kMostTracks + kMostTrees));
  assignment_.reserve(kMostTrees, kMostTracks + kMostTrees);
}

void Tracker::reset() {
  tracks_.clear();
  motion_ = {};
  motion_seconds_.reset();
}

// The robot goes on as it went, less and less surely (Ornstein and Uhlenbeck's process): where no
// tree tells its motion any more it is taken to stand still, at any speed that a ground robot has.
// It hardly goes sideways, but where its camera stands it may.
MotionEstimate Tracker::prior(double elapsed) const {
  constexpr double kShiftSeconds = 30, kTurnSeconds = 0.5;
  const MotionEstimate any{{}, 0.02 + 1.5 * elapsed, 0.01 + 0.3 * elapsed, 0.01 + 0.5 * elapsed};
  if (!motion_seconds_ || *motion_seconds_ <= 0) return any;
  const double ratio = elapsed / *motion_seconds_;
  const double shift = std::exp(-elapsed / kShiftSeconds), turn = std::exp(-elapsed / kTurnSeconds);
  const EgoMotion& last = motion_.mean;
  return {{shift * ratio * last.forward, shift * ratio * last.left, turn * ratio * last.turn},
          faded(motion_.forward_sigma * ratio, any.forward_sigma, shift),
          faded(motion_.left_sigma * ratio, any.left_sigma, shift),
          faded(motion_.turn_sigma * ratio, any.turn_sigma, turn)};
}

std::span<const int> Tracker::match(std::span<const Tree> trees, const MotionEstimate& motion) {
  costs_.assign(trees.size() * tracks_.size(), Assignment::kForbidden);
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    const Place place = place_of(tracks_[k], motion);
    for (std::size_t i = 0; i < trees.size(); ++i) {
      costs_[i * tracks_.size() + k] = cost_of(trees[i], tracks_[k], place, motion);
    }
  }
  return assignment_.solve(costs_, static_cast<int>(trees.size()), static_cast<int>(tracks_.size()),
                           2 * kGate);
}

Tracker::Place Tracker::place_of(const Track& track, const MotionEstimate& motion) {
  const GroundPoint at = moved(track.position(), motion.mean);
  const double range = std::hypot(at.x, at.y);
  return {.range = range,
          .bearing = std::atan2(at.y, at.x),
          .width = angular_width(track.diameter(), range),
          .step = farthest_step(range),
          .slack = motion.forward_sigma + motion.turn_sigma * range};
}

double Tracker::cost_of(const Tree& tree, const Track& track, const Place& place,
                        const MotionEstimate& motion) {
  const auto [range, bearing, width, farthest, slack] = place;
  const double turn = wrap_angle(tree.bearing - bearing);
  const double way = squared(tree.range - range) + squared(turn * range);
  if (way > squared(kFartherIfSame * farthest + slack)) return Assignment::kForbidden;
  const double ratio = std::log(std::max(tree.angular_width, 0.001F) / width) / kWidthSpread;
  // What stays in its place and keeps its width is one tree, whatever foot is found.
  const bool same = track.unseen() < kJustSeen && std::abs(turn) < kSamePlace * width &&
                    std::abs(ratio) < kSameWidth;
  if (way > squared((same ? kFartherIfSame : 1) * farthest + slack)) return Assignment::kForbidden;
  const Track::Expectation expected = track.expect(tree);
  const double step = tree.range - range - (expected.range - track.range());
  const double shift = squared(std::max(motion.forward_sigma, motion.left_sigma));
  const double across = expected.bearing_variance + squared(kPartOfWidth * width) +
                        squared(motion.turn_sigma) + shift / squared(range);
  const double along = expected.range_variance + squared(kPartOfRange * range) + shift;
  const double shape = ratio > 0 ? squared(ratio) : std::min(squared(ratio), kPartlySeen);
  const double aside = squared(turn) / across;
  const double misfit = aside + squared(step) / along + shape;
  if (aside > kAsideGate || misfit > kGate) return Assignment::kForbidden;
  const double doubt =
      (log_odds(tree.score, kSureEnough) - log_odds(track.probability(), kSureEnough)) /
      kScoreSpread;
  return misfit + track.unseen() + std::min(squared(doubt), kUnlike);
}

std::span<const ExpectedTrunk> Tracker::expected(double elapsed) {
  expected_.clear();
  if (!follows(elapsed)) return {};
  const EgoMotion motion = prior(elapsed).mean;
  for (const Track& track : tracks_) {
    if (track.sightings() > kFewSightings && track.probability() > kHardly &&
        track.unseen() < kLookFor && expected_.size() < kMostTrees)
      expected_.push_back(track.after(motion));
  }
  return expected_;
}

// Pairs and motion depend on each other: pair with the slack of the prior, estimate, pair anew with
// the slack of what is then left open.
MotionEstimate Tracker::estimate(std::span<const Tree> trees, const MotionEstimate& prior) {
  MotionEstimate motion = prior;
  for (int round = 0; round < 2; ++round) {
    const std::span<const int> pairs = match(trees, motion);
    sightings_.clear();
    for (std::size_t i = 0; i < trees.size(); ++i) {
      if (pairs[i] < 0) continue;
      const Track& track = tracks_[pairs[i]];
      const Track::Expectation expected = track.expect(trees[i]);
      // What is no tree of the searched range, but a stem far behind, goes with the robot.
      const double trust = std::max(trees[i].score, 0.01F);
      sightings_.push_back({track.position(), trees[i].bearing,
                            trees[i].range - (expected.range - track.range()),
                            expected.bearing_variance / trust, expected.range_variance / trust});
    }
    motion = estimate_motion(sightings_, prior);
  }
  return motion;
}

// Now a whole trunk stands out and now the half of it that is lit. What lies within the outline of
// a tree that is known better and not seen otherwise is that tree: one behind it would be hidden.
// So is what holds such an outline, as far away. The track that the sighting had is forgotten.
int Tracker::rejoin(const Tree& tree, int track) {
  int best = track;
  for (std::size_t k = 0; k < paired_.size(); ++k) {
    const int sightings = best < 0 ? 0 : tracks_[best].sightings();
    if (paired_[k] == 0 && tracks_[k].sightings() > sightings &&
        share_of(tracks_[k], tree) != Share::none)
      best = static_cast<int>(k);
  }
  if (best != track) {
    paired_[best] = 1;
    if (track >= 0) tracks_[track].forget();
  }
  if (best >= 0 && tree.score > kProbable && share_of(tracks_[best], tree) == Share::whole)
    tracks_[best].widen(tree);
  return best;
}

// Moves the tracks with the robot; returns how surely.
MotionEstimate Tracker::follow(std::span<const Tree> trees, double elapsed) {
  if (elapsed == 0) return {{}, 0.01, 0.01, 0.005};  // a camera that stamps two frames alike
  const bool first = tracks_.empty();
  motion_ = estimate(trees, prior(elapsed));
  motion_seconds_ = first ? std::nullopt : std::optional(elapsed);
  for (Track& track : tracks_) track.move(motion_, elapsed);
  return motion_;
}

// Bearings alone give tracked ranges and the motion but for one factor: too short a motion makes
// all of them shrink, and the tracks, each of which allows its range a lasting error, do not mind.
// What ranges have in common is no error of one foot.
void Tracker::rescale(std::span<const Tree> trees, std::span<const int> pairs, double elapsed) {
  double errors = 0, weights = 1 / squared(kScaleSigma);
  for (std::size_t i = 0; i < trees.size(); ++i) {
    if (pairs[i] < 0 || tracks_[pairs[i]].sightings() <= kFewSightings) continue;
    const double sigma =
        std::max<double>(trees[i].range_sigma / std::max(trees[i].range, 0.1F), kLeastError);
    const double error = std::log(std::max(trees[i].range, 0.1F) / tracks_[pairs[i]].range());
    const double weight = trees[i].score / squared(sigma);
    errors += weight * std::clamp(error, -3 * sigma, 3 * sigma);
    weights += weight;
  }
  const double factor = std::exp(std::min(1.0, elapsed / kScaleSeconds) * errors / weights);
  for (Track& track : tracks_) track.scale(factor);
  motion_.mean.forward *= factor;
  motion_.mean.left *= factor;
}

void Tracker::update(std::span<Tree> trees, double elapsed) {
  if (!follows(elapsed)) {
    reset();
    elapsed = 0;
  }
  const MotionEstimate motion = follow(trees, elapsed);

  // However badly the motion is known: an id that jumps a metre is worse than a new one.
  const MotionEstimate slack{{},
                             std::min(motion.forward_sigma, 0.05),
                             std::min(motion.left_sigma, 0.05),
                             std::min(motion.turn_sigma, 0.01)};
  const std::span<const int> pairs = match(trees, slack);
  rescale(trees, pairs, elapsed);
  paired_.assign(tracks_.size(), 0);
  for (const int k : pairs) {
    if (k >= 0) paired_[k] = 1;
  }
  for (std::size_t i = 0; i < trees.size(); ++i) {
    const float score = trees[i].score;
    const int k = rejoin(trees[i], pairs[i]);
    if (k >= 0) {
      tracks_[k].see(trees[i]);
    } else if (tracks_.size() < kMostTracks + kMostTrees) {
      tracks_.emplace_back(next_id_++, trees[i]);
    }
    if (scores_ == Scores::ranks) trees[i].score = score;
  }
  std::erase_if(tracks_, [](const Track& track) {
    return track.doubtful() > kForgetAtLast ||
           track.unseen() >
               std::min(kForgetAtLast, kForgetAfter + kForgetAfterASighting * track.sightings());
  });
  if (tracks_.size() > kMostTracks) {  // the longest unseen go first
    std::ranges::nth_element(tracks_, tracks_.begin() + kMostTracks, {}, &Track::unseen);
    tracks_.erase(tracks_.begin() + kMostTracks, tracks_.end());
  }
}

}  // namespace bole
