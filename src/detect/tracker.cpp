#include "detect/tracker.h"

#include <algorithm>
#include <cmath>

#include "geometry/angles.h"
#include "geometry/ground.h"

namespace bole {
namespace {

constexpr double kForgetAfter = 3.0;  // seconds a tree may stay unseen and keep its id
constexpr std::size_t kMostTracks = 256;
constexpr std::size_t kMostTrees = 256;   // of a frame, that room is made for
constexpr double kGate = 16.0;            // squared misfit, in variances
constexpr double kDiameterSpread = 0.35;  // of log diameter between two sightings of one tree
// What disturbs one frame (a slope, a root, the robot's pitch) disturbs the next one alike: each
// sighting after the first counts for a quarter of one.
constexpr double kAlike = 4.0;

double squared(double x) { return x * x; }

// How well a place is known, across and along the line of sight, and how far it may lie off.
struct LineOfSight {
  double bearing, range;
  double bearing_variance, range_variance;
};

LineOfSight seen_from(const GroundPoint& p, double xx, double xy, double yy) {
  const double range = std::max(std::hypot(p.x, p.y), 0.05);
  const double c = p.x / range, s = p.y / range;
  return {std::atan2(p.y, p.x), range, (s * s * xx - 2 * c * s * xy + c * c * yy) / (range * range),
          c * c * xx + 2 * c * s * xy + s * s * yy};
}

double bearing_variance(const Tree& tree) { return squared(std::max(tree.bearing_sigma, 0.003F)); }
// A robot that pitches by 0.2 degrees a frame shifts the foot of a tree at r metres by about
// 0.004 r^2 metres, whatever the detector knows.
double range_variance(const Tree& tree) {
  return squared(std::max(tree.range_sigma, 0.004F * tree.range * tree.range + 0.02F));
}
double diameter_variance(const Tree& tree) { return squared(std::max(tree.diameter_sigma, 0.01F)); }

// No two trees this far apart are ever taken for one, however badly their range is known.
double farthest_step(double range) { return std::max(0.9, 0.12 * range); }

}  // namespace

Tracker::Tracker() {
  tracks_.reserve(kMostTracks + kMostTrees);
  sightings_.reserve(kMostTrees);
  costs_.reserve(kMostTrees * (kMostTracks + kMostTrees));
  assignment_.reserve(kMostTrees, kMostTracks + kMostTrees);
}

void Tracker::reset() {
  tracks_.clear();
  motion_ = {};
  motion_seconds_.reset();
}

// The robot goes on as it went, as far as that is known, within what it can accelerate; and however
// it was seen to go, it is a ground robot, of limited speed. Where no tree tells its motion any
// more, the second wins: it is taken to stand still, at any speed it may have.
MotionEstimate Tracker::prior(double elapsed) const {
  const MotionEstimate any{{}, 0.02 + 1.5 * elapsed, 0.01 + 0.5 * elapsed};
  if (!motion_seconds_ || *motion_seconds_ <= 0) return any;
  const double ratio = elapsed / *motion_seconds_;
  const double shift =
      squared(motion_.shift_sigma * ratio) + squared(0.01 + 3.0 * elapsed * elapsed);
  const double turn =
      squared(motion_.turn_sigma * ratio) + squared(0.005 + 5.0 * elapsed * elapsed);
  const double shift_share = squared(any.shift_sigma) / (squared(any.shift_sigma) + shift);
  const double turn_share = squared(any.turn_sigma) / (squared(any.turn_sigma) + turn);
  return {{motion_.mean.forward * ratio * shift_share, motion_.mean.left * ratio * shift_share,
           motion_.mean.turn * ratio * turn_share},
          std::sqrt(shift * shift_share),
          std::sqrt(turn * turn_share)};
}

std::span<const int> Tracker::match(std::span<const Tree> trees, const MotionEstimate& motion) {
  costs_.assign(trees.size() * tracks_.size(), Assignment::kForbidden);
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    const Track& track = tracks_[k];
    // The track's covariance is turned with it only once the motion is settled: the turn is small.
    const LineOfSight expected =
        seen_from(moved(track.position, motion.mean), track.xx, track.xy, track.yy);
    const double reach =
        farthest_step(expected.range) + motion.shift_sigma + motion.turn_sigma * expected.range;
    for (std::size_t i = 0; i < trees.size(); ++i) {
      const Tree& tree = trees[i];
      const double bearing_error = wrap_angle(tree.bearing - expected.bearing);
      const double range_error = tree.range - expected.range;
      if (std::hypot(range_error, bearing_error * expected.range) > reach) continue;
      const double shift = squared(motion.shift_sigma);
      const double across = expected.bearing_variance + bearing_variance(tree) +
                            squared(motion.turn_sigma) + shift / squared(expected.range);
      const double along = expected.range_variance + range_variance(tree) + shift;
      const double misfit = squared(bearing_error) / across + squared(range_error) / along;
      if (misfit > kGate) continue;
      const double shape = std::log(std::max(tree.diameter, 0.01F) / track.diameter);
      costs_[i * tracks_.size() + k] = misfit + squared(shape / kDiameterSpread) + track.unseen;
    }
  }
  return assignment_.solve(costs_, static_cast<int>(trees.size()), static_cast<int>(tracks_.size()),
                           2 * kGate);
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
      const LineOfSight known = seen_from(track.position, track.xx, track.xy, track.yy);
      sightings_.push_back({track.position, trees[i].bearing, trees[i].range,
                            known.bearing_variance + bearing_variance(trees[i]),
                            known.range_variance + range_variance(trees[i])});
    }
    motion = estimate_motion(sightings_, prior);
  }
  return motion;
}

void Tracker::move_tracks(const EgoMotion& motion, double elapsed) {
  const double c = std::cos(motion.turn), s = std::sin(motion.turn);
  for (Track& track : tracks_) {
    track.position = moved(track.position, motion);
    const double xx = track.xx, xy = track.xy, yy = track.yy;
    // What the motion's own error adds grows with the distance, through the turn.
    const double noise =
        squared(0.01 + 0.003 * std::hypot(track.position.x, track.position.y)) * (elapsed / 0.1);
    track.xx = c * c * xx + 2 * c * s * xy + s * s * yy + noise;
    track.xy = c * s * (yy - xx) + (c * c - s * s) * xy;
    track.yy = s * s * xx - 2 * c * s * xy + c * c * yy + noise;
    track.unseen += elapsed;
  }
}

// Kalman's update in the axes of the line of sight, where both covariances are nearly diagonal.
void Tracker::fuse(Track& track, Tree& tree) {
  const LineOfSight known = seen_from(track.position, track.xx, track.xy, track.yy);
  const double across = bearing_variance(tree), along = kAlike * range_variance(tree);
  const double across_gain = known.bearing_variance / (known.bearing_variance + across);
  const double along_gain = known.range_variance / (known.range_variance + along);
  const double bearing =
      wrap_angle(known.bearing + across_gain * wrap_angle(tree.bearing - known.bearing));
  const double range = known.range + along_gain * (tree.range - known.range);
  const double across_variance = (1 - across_gain) * known.bearing_variance * squared(range);
  const double along_variance = (1 - along_gain) * known.range_variance;
  const double c = std::cos(bearing), s = std::sin(bearing);
  track.position = {range * c, range * s};
  track.xx = c * c * along_variance + s * s * across_variance;
  track.xy = c * s * (along_variance - across_variance);
  track.yy = s * s * along_variance + c * c * across_variance;

  const double noise = kAlike * diameter_variance(tree);
  const double gain = track.diameter_variance / (track.diameter_variance + noise);
  track.diameter += gain * (tree.diameter - track.diameter);
  track.diameter_variance = (1 - gain) * track.diameter_variance + squared(0.001);
  track.unseen = 0;

  tree.id = track.id;
  tree.bearing = static_cast<float>(bearing);
  tree.range = static_cast<float>(range);
  tree.diameter = static_cast<float>(track.diameter);
  tree.bearing_sigma = static_cast<float>(std::sqrt(across_variance) / range);
  tree.range_sigma = static_cast<float>(std::sqrt(along_variance));
  tree.diameter_sigma = static_cast<float>(std::sqrt(track.diameter_variance));
  tree.angular_width = static_cast<float>(angular_width(track.diameter, range));
}

Tracker::Track Tracker::begin(Tree& tree) {
  tree.id = next_id_++;
  const double c = std::cos(tree.bearing), s = std::sin(tree.bearing);
  const double along = range_variance(tree), across = bearing_variance(tree) * squared(tree.range);
  return {.id = tree.id,
          .position = {tree.range * c, tree.range * s},
          .xx = c * c * along + s * s * across,
          .xy = c * s * (along - across),
          .yy = s * s * along + c * c * across,
          .diameter = std::max(tree.diameter, 0.01F),
          .diameter_variance = diameter_variance(tree),
          .unseen = 0};
}

void Tracker::update(std::span<Tree> trees, double elapsed,
                     const std::optional<EgoMotion>& odometry) {
  constexpr double kLongestStep = 2.0;  // seconds; after longer, nothing says how the robot moved
  if (!(elapsed > 0) || elapsed > kLongestStep) {
    reset();
    elapsed = 0;
  }
  const bool first = tracks_.empty();
  motion_ = odometry ? MotionEstimate{*odometry, 0.01, 0.005} : estimate(trees, prior(elapsed));
  motion_seconds_ = first ? std::nullopt : std::optional(elapsed);
  move_tracks(motion_.mean, elapsed);

  // However badly the motion is known: an id that jumps a metre is worse than a new one.
  const std::span<const int> pairs =
      match(trees, {{}, std::min(motion_.shift_sigma, 0.05), std::min(motion_.turn_sigma, 0.01)});
  for (std::size_t i = 0; i < trees.size(); ++i) {
    if (pairs[i] >= 0) {
      fuse(tracks_[pairs[i]], trees[i]);
    } else if (tracks_.size() < kMostTracks + kMostTrees) {
      tracks_.push_back(begin(trees[i]));
    }
  }
  std::erase_if(tracks_, [](const Track& track) { return track.unseen > kForgetAfter; });
  if (tracks_.size() > kMostTracks) {  // the longest unseen go first
    std::ranges::nth_element(tracks_, tracks_.begin() + kMostTracks, {}, &Track::unseen);
    tracks_.resize(kMostTracks);
  }
}

}  // namespace bole
