#include "detect/range_posterior.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bole {
namespace {

constexpr double kTypicalDiameter = 0.3;  // metres, median
constexpr double kDiameterSpread = 0.5;   // standard deviation of the logarithm
constexpr double kVisibility = 30;        // metres that a tree is seen through others, mean
constexpr double kAttitudeSigma = 0.003;  // tangent
constexpr double kGroundSigma = 0.015;    // metres, of even ground
constexpr double kRoughShare = 0.1;       // of trees whose foot is not where even ground has it
constexpr double kRoughSigma = 0.12;      // tangent
constexpr double kNearest = 0.5, kFarthest = 100;  // metres
constexpr double kStep = 0.5;  // of the even ground's points, standard deviations
constexpr double kRangeTolerance = 1.1, kDiameterTolerance = 1.3;  // lists reach so far beyond

double square(double x) { return x * x; }

// Density over the logarithm of the range of trees that span 2 asin(s), times exp(`exponent`), but
// for a factor.
double prior(double range, double log_range, double log_s, double exponent) {
  const double size = (log_range + log_s + std::log(2 / kTypicalDiameter)) / kDiameterSpread;
  return range * std::exp(exponent - 0.5 * square(size) - range / kVisibility);
}

}  // namespace

RangePosterior::RangePosterior(double height, const Search& search)
    : height_(height), search_(search) {
  for (int i = 0; i < kRoughSteps; ++i) {
    const double part = (i + 0.5) / kRoughSteps;
    rough_log_range_[i] = std::log(kNearest) + part * std::log(kFarthest / kNearest);
    rough_range_[i] = std::exp(rough_log_range_[i]);
  }
}

bool RangePosterior::is_searched(double range, double diameter) const {
  return range >= search_.range.low / kRangeTolerance &&
         range <= search_.range.high * kRangeTolerance &&
         diameter >= search_.diameter.low / kDiameterTolerance &&
         diameter <= search_.diameter.high * kDiameterTolerance;
}

RangePosterior::Points RangePosterior::points(const TrunkSight& sight) const {
  const double s = std::sin(sight.angular_width / 2);
  const double uneven = kGroundSigma * std::max(0.0, sight.down) / height_;
  const double sigma = std::hypot(sight.down_sigma, kAttitudeSigma, uneven);
  const double log_s = std::log(s);
  Points points;
  constexpr int kMiddle = kEvenSteps / 2;
  for (int i = 0; i < kEvenSteps; ++i) {
    const double off = kStep * (i - kMiddle);
    const double down = std::max(sight.down + off * sigma, 1e-4);
    const double range = height_ / (down * (1 - s)), log_range = std::log(range);
    const bool real = !sight.cut && sight.down + off * sigma > 1e-4;
    points.range[i] = range;
    points.log_range[i] = log_range;
    // d log(range) = d down / down; the normal density's sigma cancels the step's.
    points.weight[i] =
        real ? (1 - kRoughShare) * kStep / down * prior(range, log_range, log_s, -0.5 * square(off))
             : 0;
  }
  const double step = std::log(kFarthest / kNearest) / kRoughSteps;
  const double rough_sigma = std::hypot(kRoughSigma, sight.down_sigma);
  for (int i = 0; i < kRoughSteps; ++i) {
    const double range = rough_range_[i], log_range = rough_log_range_[i];
    const double above = (sight.down - height_ / (range * (1 - s))) / rough_sigma;
    const double off = sight.cut ? std::max(above, 0.0) : above;
    points.range[kEvenSteps + i] = range;
    points.log_range[kEvenSteps + i] = log_range;
    points.weight[kEvenSteps + i] =
        kRoughShare * step / rough_sigma * prior(range, log_range, log_s, -0.5 * square(off));
  }
  return points;
}

double RangePosterior::log_likelihood(const TrunkSight& sight) const {
  const Points p = points(sight);
  return std::log(std::accumulate(p.weight.begin(), p.weight.end(), 1e-30));
}

double RangePosterior::log_likelihood_of_searched(const TrunkSight& sight) const {
  const Points p = only_searched(points(sight), std::sin(sight.angular_width / 2));
  return std::log(std::accumulate(p.weight.begin(), p.weight.end(), 1e-30));
}

RangePosterior::Points RangePosterior::only_searched(Points p, double s) const {
  for (int i = 0; i < kSteps; ++i)
    if (!is_searched(p.range[i], 2 * p.range[i] * s)) p.weight[i] = 0;
  return p;
}

RangeEstimate RangePosterior::estimate(const TrunkSight& sight) const {
  const Points everywhere = points(sight);
  const double s = std::sin(sight.angular_width / 2);
  const double all = std::accumulate(everywhere.weight.begin(), everywhere.weight.end(), 1e-30);
  const Points p = only_searched(everywhere, s);
  const double even = std::accumulate(p.weight.begin(), p.weight.begin() + kEvenSteps, 0.0);
  const double searched = std::accumulate(p.weight.begin() + kEvenSteps, p.weight.end(), even);
  if (searched <= 0) return {};

  // The mean over what most likely is the case; the deviation about it over all that may be.
  const int last = even > 0.5 * searched ? kEvenSteps : kSteps;
  const double mass = even > 0.5 * searched ? even : searched;
  const double mean =
      std::inner_product(p.weight.begin(), p.weight.begin() + last, p.log_range.begin(), 0.0) /
      mass;
  const double range = std::exp(mean);
  return {.range = range,
          .sigma = range * half_of_95_percent(everywhere, mean, all),
          .searched = std::min(1.0, searched / all)};
}

// Half the deviation from `mean` within which 95 % of the mass lies: the standard deviation of a
// normal distribution, and of one with far tails what its bulk has.
double RangePosterior::half_of_95_percent(const Points& p, double mean, double mass) {
  // From the farthest point inwards, until more than 5 % lie outside. Along even ground's points
  // the range falls, along the rough ones it rises: the farthest left of either is one of its ends.
  struct Left {
    int first, last;
  };
  const auto deviation = [&](int i) { return std::abs(p.log_range[i] - mean); };
  const auto farthest = [&](Left left) {
    return deviation(left.first) > deviation(left.last) ? left.first : left.last;
  };
  Left even{0, kEvenSteps - 1}, rough{kEvenSteps, kSteps - 1};
  double outside = 0, reached = 0;
  while (outside <= 0.05 * mass && (even.first <= even.last || rough.first <= rough.last)) {
    const bool of_even =
        rough.first > rough.last ||
        (even.first <= even.last && deviation(farthest(even)) > deviation(farthest(rough)));
    Left& left = of_even ? even : rough;
    const int point = farthest(left);
    if (point == left.first) {
      ++left.first;
    } else {
      --left.last;
    }
    outside += p.weight[point];
    reached = deviation(point);
  }
  return reached / 2;
}

}  // namespace bole
