#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "detect/expected_trunk.h"
#include "detect/tracking/assignment.h"
#include "detect/tracking/ego_motion.h"
#include "detect/tracking/track.h"
#include "detect/tree.h"

namespace bole {

/// Keeps the ids of trees stable while the robot drives, and sharpens score, range and diameter
/// from frame to frame. Adds no latency: every tree handed in is handed out, none is held back to
/// be confirmed, none is invented that this frame does not show.
class Tracker {
 public:
  /// Of one frame, that are worth tracking: twice what a list holds.
  static constexpr std::size_t kMostTrees = 64;

  /// `scores`: what those of the trees mean. Only probabilities are sharpened by time.
  enum class Scores { probabilities, ranks };
  explicit Tracker(Scores scores = Scores::probabilities);

  /// Gives each tree of one frame its id, and replaces score, bearing, range, diameter, their
  /// sigmas and angular_width by the estimate from this and the earlier frames. Hand in improbable
  /// trees too, down to a score of 0.05: they may be what is seen of a probable one. Allocates
  /// nothing for up to kMostTrees. `elapsed`: seconds since the last frame; 0 for one of the same
  /// instant. The motion since then is estimated from the trees themselves.
  void update(std::span<Tree> trees, double elapsed);

  /// Where trees that were probable of late should be seen `elapsed` seconds after the last update.
  /// At most kMostTrees; valid until the next call. Allocates nothing.
  std::span<const ExpectedTrunk> expected(double elapsed);

  /// The motion between the last two frames of different instants, as estimated.
  const EgoMotion& last_motion() const { return motion_.mean; }

  /// Forgets every tree (ids are never used again) and the motion.
  void reset();

 private:
  MotionEstimate prior(double elapsed) const;
  MotionEstimate estimate(std::span<const Tree> trees, const MotionEstimate& prior);
  MotionEstimate follow(std::span<const Tree> trees, double elapsed);
  /// The track of each tree, -1 for none, if the robot has moved by `motion`, within its sigmas.
  std::span<const int> match(std::span<const Tree> trees, const MotionEstimate& motion);
  /// Where a track's tree should be seen, and how far from there it may be at most.
  struct Place {
    double range, bearing, width;
    double step, slack;
  };
  static Place place_of(const Track& track, const MotionEstimate& motion);
  static double cost_of(const Tree& tree, const Track& track, const Place& place,
                        const MotionEstimate& motion);
  /// Brings tracks and motion to the scale of the ranges seen.
  void rescale(std::span<const Tree> trees, std::span<const int> pairs, double elapsed);
  /// The track that a sighting, paired with `track` (-1: none), is part or whole of.
  int rejoin(const Tree& tree, int track);

  Scores scores_;
  std::vector<Track> tracks_;
  std::vector<char> paired_;  // tracks with a sighting in this frame
  MotionEstimate motion_;
  std::optional<double> motion_seconds_;  // what motion_ took; nothing before the second frame
  std::int32_t next_id_ = 0;
  Assignment assignment_;
  std::vector<double> costs_;
  std::vector<Sighting> sightings_;
  std::vector<ExpectedTrunk> expected_;
};

}  // namespace bole
