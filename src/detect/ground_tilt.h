#pragma once

#include <array>
#include <span>
#include <vector>

#include "detect/range_posterior.h"

namespace bole {

/// How the ground seems to rise beside what the mount says of it, as tangents towards bearings 0
/// and pi/2: the robot's tilt against its usual stand, or a slope.
struct GroundTilt {
  double forward = 0, left = 0;
  double sigma = 0;  ///< of `raise`, a tangent, beside what the mount's calibration leaves open

  /// By how much ground at this bearing seems raised, a tangent.
  double raise(double bearing) const;
  double raise(double cos_bearing, double sin_bearing) const {
    return forward * cos_bearing + left * sin_bearing;
  }
  /// The lean, columns a row of the panorama, that a tilted camera gives to an upright trunk there.
  double lean(double bearing) const;
  double lean(double cos_bearing, double sin_bearing) const {
    return forward * sin_bearing - left * cos_bearing;
  }
};

/// A trunk as a witness of the tilt.
struct TiltWitness {
  double bearing = 0;
  TrunkSight sight;
  double lean = 0;    ///< columns a row, to the right going down
  double weight = 0;  ///< probability that it is a trunk
};

/// Estimates the tilt from the trunks of one frame: by their feet, which under a wrong tilt would
/// stand where no tree of their width is likely, and by their lean, which tells the robot's tilt
/// from a slope.
///
/// Three hypotheses are weighed by Bayes' rule: the mount is as calibrated and the ground level;
/// the camera is tilted; the ground slopes. For the latter two the likelihood is summed over the
/// tilts that there may be, so that a tilt must not only explain the trunks but do it better than
/// chance would let one of so many. Says that there is none unless that is less probable than
/// another hypothesis, as ten trunks know the tilt less well than a calibrated mount does; `sigma`
/// tells how well.
class TiltEstimator {
 public:
  static constexpr std::size_t kMostWitnesses = 256;  ///< that are weighed without allocating

  explicit TiltEstimator(double height);

  GroundTilt estimate(std::span<const TiltWitness> witnesses);

 private:
  static constexpr int kWidths = 24, kDowns = 181, kLeans = 64;
  static constexpr int kReach = 5, kAcross = 2 * kReach + 1;  // steps from no tilt, from end to end
  static constexpr int kTilts = kAcross * kAcross;            // that are weighed

  // A witness as one tilt after the other needs it.
  struct Ready {
    const float* feet;  // log likelihood of its width by depression
    double down, cos_bearing, sin_bearing, lean, weight;
  };
  using ByTilt = std::array<double, kTilts>;  // logarithms
  struct Hypothesis {
    double log_probability = 0;  // but for what it has in common with the others
    GroundTilt likeliest;
    double sigma = 0;  // in one direction
  };

  Ready made_ready(const TiltWitness& witness) const;
  double feet(const GroundTilt& ground) const;
  double lean(const GroundTilt& camera) const;
  Hypothesis weigh(const ByTilt& values) const;
  template <class Value>
  static GroundTilt climb(const Value& value, const GroundTilt& start);

  std::array<GroundTilt, kTilts> tilts_;         // row by row of one `left`, from the least on
  std::vector<std::array<float, kDowns>> feet_;  // log likelihood by width and depression
  std::array<float, kLeans> leans_;              // log likelihood by lean
  std::vector<Ready> ready_;
};

}  // namespace bole
