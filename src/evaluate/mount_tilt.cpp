#include "evaluate/mount_tilt.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "geometry/angles.h"

namespace bole {
namespace {

constexpr double kTiltSigma = 0.1;        // tangent, before anything is seen
constexpr double kLeanShown = 0.8;        // of a lean: where its edges disagree, the fit takes the
                                          // more upright one
constexpr double kLeanSigma = 0.03;       // tangent, of trunks, as it shows
constexpr double kFootSigma = 0.004;      // tangent
constexpr double kTypicalDiameter = 0.3;  // metres
constexpr double kDiameterSpread = 0.5;   // of its logarithm
constexpr double kLeastDown = 0.02;       // tangent of the farthest foot that tells anything
constexpr double kTail = 4;               // of the residuals' distribution: degrees of freedom
constexpr double kCommonSlope = 0.01;     // of ground that is taken for level, along each axis
constexpr double kMostTrunks = 100;       // neighbours lean alike: more do not tell more
constexpr double kStill = 0.03;           // radians, and tangent: a trunk seen twice from one place
constexpr double kPassing = 0.6;          // of its width: what it moves from frame to frame
constexpr int kMissed = 5;                // frames in which it may be overlooked
constexpr double kSameWidth = 0.3;        // of the logarithm
constexpr double kSameFoot = 0.15;        // of the tangent

// A witness and the trunk it is of.
struct Sighting {
  TiltWitness seen;
  int trunk = 0, frame = 0;
  double share = 0;  // of its trunk, times the probability that it is one
};

// How far apart two sightings are, 0 to 2; infinite when they cannot be of one trunk.
double apart(const TiltWitness& a, const TiltWitness& b) {
  const double turn =
      std::abs(wrap_angle(a.bearing - b.bearing)) / (kStill + kPassing * a.sight.angular_width);
  const double growth =
      std::abs(std::log(a.sight.angular_width / b.sight.angular_width)) / kSameWidth;
  const double foot =
      std::abs(a.sight.down - b.sight.down) / (kStill + kSameFoot * std::max(0.0, b.sight.down));
  return std::max({turn, growth, foot}) < 1 ? turn + growth
                                            : std::numeric_limits<double>::infinity();
}

// Each goes to the trunk of the nearest sighting of late that none of its frame has taken yet; -1
// where there is none.
std::vector<Sighting> recognise(const std::vector<TiltWitness>& frame, int now,
                                std::vector<Sighting> latest) {
  std::vector<Sighting> here;
  for (const TiltWitness& witness : frame) {
    const auto nearest = std::ranges::min_element(
        latest, {}, [&](const Sighting& other) { return apart(witness, other.seen); });
    const bool known = nearest != latest.end() && std::isfinite(apart(witness, nearest->seen));
    here.push_back({witness, known ? nearest->trunk : -1, now});
    if (known) latest.erase(nearest);
  }
  return here;
}

// A frame of which little is recognised is of another place, where the rest is so by chance.
bool elsewhere(const std::vector<Sighting>& frame) {
  return 2 * std::ranges::count(frame, -1, &Sighting::trunk) > std::ssize(frame);
}

std::vector<Sighting> follow_trunks(std::span<const std::vector<TiltWitness>> frames) {
  std::vector<Sighting> all, latest;  // of each trunk the latest sighting
  int trunks = 0, now = 0;
  for (const std::vector<TiltWitness>& frame : frames) {
    std::vector<Sighting> here = recognise(frame, now++, latest);
    if (elsewhere(here)) {
      latest.clear();
      for (Sighting& sighting : here) sighting.trunk = -1;
    }
    for (Sighting& sighting : here) {
      if (sighting.trunk < 0) sighting.trunk = trunks++;
    }
    std::erase_if(latest, [&](const Sighting& old) {
      return old.frame + kMissed < now ||
             std::ranges::find(here, old.trunk, &Sighting::trunk) != here.end();
    });
    latest.insert(latest.end(), here.begin(), here.end());
    all.insert(all.end(), here.begin(), here.end());
  }
  return all;
}

// Returns the number of trunks.
int share_out(std::vector<Sighting>& sightings) {
  const auto last = std::ranges::max_element(sightings, {}, &Sighting::trunk);
  std::vector<int> times(last == sightings.end() ? 0 : last->trunk + 1);
  for (const Sighting& s : sightings) ++times[s.trunk];
  double all = 0;
  for (Sighting& s : sightings) all += s.share = s.seen.weight / times[s.trunk];
  for (Sighting& s : sightings) s.share *= std::min(1.0, kMostTrunks / all);
  return static_cast<int>(times.size());
}

template <int N>
struct Equation {
  cv::Vec<double, N> factors;
  double value = 0, sigma = 0, weight = 0;
};

template <int N>
struct Solution {
  cv::Vec<double, N> x;
  cv::Matx<double, N, N> covariance;
};

// The most probable x under Student's distribution of residuals and a normal one of x about
// `start`, by weighted least squares.
template <int N>
Solution<N> solve(const std::vector<Equation<N>>& equations, const cv::Vec<double, N>& start,
                  const cv::Vec<double, N>& start_sigma) {
  constexpr int kSteps = 20;
  cv::Matx<double, N, N> prior = cv::Matx<double, N, N>::zeros();
  for (int i = 0; i < N; ++i) prior(i, i) = 1 / (start_sigma[i] * start_sigma[i]);
  Solution<N> solution{start, {}};
  for (int step = 0; step < kSteps; ++step) {
    cv::Matx<double, N, N> information = prior;
    cv::Vec<double, N> sum = prior * start;
    double misfit = 0, mass = 0;
    for (const Equation<N>& e : equations) {
      const double off = (e.value - e.factors.dot(solution.x)) / e.sigma;
      const double trust = e.weight * (kTail + 1) / (kTail + off * off);
      const double weight = trust / (e.sigma * e.sigma);
      information += weight * (e.factors * e.factors.t());
      sum += weight * e.value * e.factors;
      misfit += trust * off * off;
      mass += e.weight;
    }
    const cv::Matx<double, N, N> inverse = information.inv(cv::DECOMP_SVD);
    solution = {inverse * sum, inverse * std::max(1.0, misfit / std::max(1.0, mass - N))};
  }
  return solution;
}

TiltFigure tilt_by_lean(const std::vector<Sighting>& sightings) {
  std::vector<Equation<2>> equations;
  for (const Sighting& s : sightings) {
    const double b = s.seen.bearing;
    equations.push_back(
        {{kLeanShown * std::sin(b), -kLeanShown * std::cos(b)}, s.seen.lean, kLeanSigma, s.share});
  }
  const Solution<2> found = solve<2>(equations, {0, 0}, {kTiltSigma, kTiltSigma});
  return {found.x, found.covariance};
}

// What varies is the width at a given depression, by the trees' diameters: so it is log x that is
// fitted, and not the depression. Far trees that are found at all are thicker ones, which looks as
// if the ground fell on all sides: that is fitted too, and with it goes what trunks on one side
// only seem to tell.
TiltFigure tilt_by_feet(const std::vector<Sighting>& sightings, double height) {
  constexpr int kRounds = 10;  // each linear about what the one before found
  const cv::Vec4d start{0, 0, 0, std::log(2 * height / kTypicalDiameter)};
  Solution<4> found{start, {}};
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Equation<4>> equations;
    for (const Sighting& s : sightings) {
      const double cosine = std::cos(s.seen.bearing), sine = std::sin(s.seen.bearing);
      const double raise = cosine * found.x[0] + sine * found.x[1] + found.x[2];
      const double down = std::max(kLeastDown, s.seen.sight.down + raise);
      const double half = std::sin(s.seen.sight.angular_width / 2), x = half / (1 - half);
      const cv::Vec4d factors{cosine / down, sine / down, 1 / down, -1};
      const double off = std::log(x) - (std::log(down) - found.x[3]);
      equations.push_back(
          {factors, off + factors.dot(found.x),
           std::hypot(kDiameterSpread, s.seen.sight.down_sigma / down, kFootSigma / down),
           s.share});
    }
    found = solve<4>(equations, start, {kTiltSigma, kTiltSigma, kTiltSigma, kDiameterSpread});
  }
  return {
      {found.x[0], found.x[1]},
      found.covariance.get_minor<2, 2>(0, 0) + kCommonSlope * kCommonSlope * cv::Matx22d::eye()};
}

TiltFigure joined(const TiltFigure& a, const TiltFigure& b) {
  const cv::Matx22d by_a = a.covariance.inv(), by_b = b.covariance.inv();
  const cv::Matx22d covariance = (by_a + by_b).inv();
  return {covariance * (by_a * a.tilt + by_b * b.tilt), covariance};
}

}  // namespace

MountTilt estimate_mount_tilt(std::span<const std::vector<TiltWitness>> frames, double height) {
  std::vector<Sighting> sightings = follow_trunks(frames);
  MountTilt result;
  result.trunks = share_out(sightings);
  result.by_lean = tilt_by_lean(sightings);
  result.by_feet = tilt_by_feet(sightings, height);
  result.both = joined(result.by_lean, result.by_feet);
  return result;
}

}  // namespace bole
