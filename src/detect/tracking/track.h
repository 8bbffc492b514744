#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "detect/expected_trunk.h"
#include "detect/tracking/ego_motion.h"
#include "detect/tracking/track_score.h"
#include "detect/tree.h"
#include "geometry/rotation.h"

namespace bole {

/// One tree that is followed from frame to frame: where it stands as seen from the robot, how thick
/// it is, how probable.
///
/// Kalman's filter over (x, y, u). The detector's range of one tree errs in one direction for
/// seconds: the ground at its foot is higher or lower than the robot's, or grass hides the foot. u
/// is that lasting error in units of the range_sigma that the detector states, so that
///   range seen = |(x, y)| + range_sigma u + noise.
/// What sharpens the range is therefore less the mean of many ranges than the bearings from along
/// the robot's way.
class Track {
 public:
  /// Begins with a tree's first sighting, of which only id and score change.
  Track(std::int32_t id, Tree& tree);

  /// The robot has moved on, as far as known; `elapsed` seconds have passed.
  void move(const MotionEstimate& motion, double elapsed);

  /// Takes in what this frame shows of the tree, and puts what is known of it now in its place.
  void see(Tree& tree);

  /// Where the detector should see the tree, and the variances of the difference of the sighting
  /// `tree` from that.
  struct Expectation {
    double bearing, range;
    double bearing_variance, range_variance;
  };
  Expectation expect(const Tree& tree) const;

  /// How it should look after the robot has moved on by `motion`.
  ExpectedTrunk after(const EgoMotion& motion) const;

  std::int32_t id() const { return id_; }
  GroundPoint position() const { return {state_.x, state_.y}; }
  double range() const { return std::hypot(state_.x, state_.y); }
  double diameter() const { return diameter_; }
  double unseen() const { return unseen_; }      ///< seconds
  double doubtful() const { return doubtful_; }  ///< seconds since it last looked like a tree
  int sightings() const { return sightings_; }
  double probability() const { return probability_; }  ///< when it was last seen
  /// The world is larger by this factor than was thought.
  void scale(double factor);
  /// What was seen so far was but a part of the tree: it is as wide as this, and stands there.
  void widen(const Tree& whole);
  void forget() { unseen_ = std::numeric_limits<double>::infinity(); }

 private:
  void judge(Tree& tree);
  void write(Tree& tree) const;
  double range_variance() const;
  double drop_of(const Tree& tree) const;
  // Kalman's update by one number, `residual` = seen - expected, that grows by `gradient` with the
  // state.
  void observe(const Vec3& gradient, double residual, double variance);
  Vec3 bearing_gradient() const;
  Vec3 range_gradient(const Tree& tree) const;

  std::int32_t id_;
  Vec3 state_;
  Mat3 covariance_;
  double diameter_, diameter_variance_;
  double drop_;  // metres from the viewpoint's height down to the foot as it is seen
  double unseen_ = 0, doubtful_ = 0;
  int sightings_ = 0;
  int frames_ = 1;  // from the first sighting on
  double probability_ = 0;
  TrackScore score_;
};

}  // namespace bole
