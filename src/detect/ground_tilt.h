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
/// from a slope. Says that there is none unless the trunks speak clearly for one: the mount is
/// calibrated, and ten trunks know the tilt less well than it does.
class TiltEstimator {
 public:
  explicit TiltEstimator(double height);

  GroundTilt estimate(std::span<const TiltWitness> witnesses);

 private:
  static constexpr int kWidths = 24, kDowns = 181, kLeans = 64;

  // A witness as one tilt after the other needs it.
  struct Ready {
    const float* feet;  // log likelihood of its width by depression
    double place;       // of its depression among them
    double cos_bearing, sin_bearing, lean, weight;
  };
  struct Found {
    GroundTilt tilt;
    double value = 0;
  };

  Ready made_ready(const TiltWitness& witness) const;
  static double feet(const Ready& witness, const GroundTilt& tilt);
  double lean(double off) const;
  template <class Value>
  static Found climb(const Value& value, double start);

  std::vector<std::array<float, kDowns>> feet_;  // log likelihood by width and depression
  std::array<float, kLeans> leans_;              // log likelihood by lean
  std::vector<Ready> ready_;
};

}  // namespace bole
