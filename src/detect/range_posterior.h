#pragma once

#include <array>

#include "geometry/camera_config.h"

namespace bole {

/// What a trunk's picture says of where it stands.
struct TrunkSight {
  double down = 0;           ///< tangent of the foot's depression; negative above the horizon
  double down_sigma = 0;     ///< standard deviation of its measurement
  double angular_width = 0;  ///< radians
  bool cut = false;          ///< the foot is out of sight below that
};

/// Where it stands, from foot, width and what is known of trees and ground.
struct RangeEstimate {
  double range = 0;     ///< metres to the axis; within the searched range and a tenth
  double sigma = 0;     ///< standard deviation about it
  double searched = 0;  ///< probability that range and diameter are among the searched ones
};

/// The range of a trunk by Bayes' rule.
///
/// Prior: diameters are log-normal, and trees stand everywhere but hide each other. Likelihood of
/// the foot: on even ground down = height / (range (1 - s)) with s = sin(width / 2), but for the
/// attitude's error and the ground's unevenness; with a small probability the ground rises or
/// falls, or something hides the foot, and then it says little. So the foot decides as long as it
/// agrees with a tree of a likely size, and the width takes over where it does not. Of a foot out
/// of sight it is only known that the tree stands nearer than where the sight ends.
class RangePosterior {
 public:
  RangePosterior(double height, const Search& search);

  RangeEstimate estimate(const TrunkSight& sight) const;

  /// The logarithm of the likelihood that a trunk of this width has its foot there; comparable
  /// between sights of one width.
  double log_likelihood(const TrunkSight& sight) const;

  /// The logarithm of the likelihood that one of the searched trunks has this width and its foot
  /// there, but for a constant; -69 where none can.
  double log_likelihood_of_searched(const TrunkSight& sight) const;

 private:
  static constexpr int kEvenSteps = 13, kRoughSteps = 40;
  static constexpr int kSteps = kEvenSteps + kRoughSteps;
  struct Points {  // of the posterior: those of even ground first
    std::array<double, kSteps> range, log_range, weight;
  };

  Points points(const TrunkSight& sight) const;
  Points only_searched(Points points, double s) const;
  static double half_of_95_percent(const Points& points, double mean, double mass);
  bool is_searched(double range, double diameter) const;

  double height_;
  Search search_;
  std::array<double, kRoughSteps> rough_range_, rough_log_range_;
};

}  // namespace bole
