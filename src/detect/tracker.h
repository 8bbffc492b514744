#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "detect/assignment.h"
#include "detect/ego_motion.h"
#include "detect/tree.h"

namespace bole {

/// Keeps the ids of trees stable while the robot drives, and sharpens range and diameter from frame
/// to frame. Adds no latency: every tree handed in is handed out, none is held back to be
/// confirmed, none is invented that this frame does not show.
class Tracker {
 public:
  Tracker();

  /// Gives each tree of one frame its id, and replaces bearing, range, diameter, their sigmas and
  /// angular_width by the estimate from this and the earlier frames. `elapsed`: seconds since the
  /// last frame. `odometry`: the motion since then where it is measured; else it is estimated from
  /// the trees themselves.
  void update(std::span<Tree> trees, double elapsed, const std::optional<EgoMotion>& odometry = {});

  /// The motion between the last two frames, as measured or estimated.
  const EgoMotion& last_motion() const { return motion_.mean; }

  /// Forgets every tree (ids are never used again) and the motion.
  void reset();

 private:
  struct Track {
    std::int32_t id = 0;
    GroundPoint position;           // robot frame of the last frame
    double xx = 0, xy = 0, yy = 0;  // its covariance, square metres
    double diameter = 0, diameter_variance = 0;
    double unseen = 0;  // seconds
  };

  MotionEstimate prior(double elapsed) const;
  MotionEstimate estimate(std::span<const Tree> trees, const MotionEstimate& prior);
  /// The track of each tree, -1 for none, if the robot has moved by `motion`, within its sigmas.
  std::span<const int> match(std::span<const Tree> trees, const MotionEstimate& motion);
  void move_tracks(const EgoMotion& motion, double elapsed);
  static void fuse(Track& track, Tree& tree);
  Track begin(Tree& tree);

  std::vector<Track> tracks_;
  MotionEstimate motion_;
  std::optional<double> motion_seconds_;  // what motion_ took; nothing before the second frame
  std::int32_t next_id_ = 0;
  Assignment assignment_;
  std::vector<double> costs_;
  std::vector<Sighting> sightings_;
};

}  // namespace bole
