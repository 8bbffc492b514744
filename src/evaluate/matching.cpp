#include "evaluate/matching.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "evaluate/detections.h"
#include "geometry/angles.h"

namespace bole {
namespace {

// Python's wrap_angle and hypot, to the last digit: its figures are the definition.
double wrap_as_python(double angle) {
  const double turned = std::fmod(angle + kPi, 2 * kPi);
  return (turned < 0 ? turned + 2 * kPi : turned) - kPi;
}
double hypot_as_python(double x, double y) {
  return static_cast<double>(std::hypot(static_cast<long double>(x), static_cast<long double>(y)));
}

double half_width(double diameter, double range) {
  return std::asin(std::min(0.99, diameter / 2 / range));
}

bool within_judged_range(double range) { return 1 <= range && range <= 8; }

// A rectangle in the panorama: half its width, and the tangent of its lower border.
struct Box {
  double half_width, base;
};

}  // namespace

bool eligible(const TruthTree& tree) {
  return within_judged_range(*tree.range) && 0.2 <= tree.diameter && tree.diameter <= 0.8 &&
         tree.visible >= 0.5;
}

std::optional<double> gated_error(const TruthTree& truth, const Tree& tree, bool metric) {
  const double half = metric ? half_width(truth.diameter, *truth.range) : truth.angular_width / 2;
  const double bearing = as_printed(tree.bearing);
  const double turn = std::abs(wrap_as_python(bearing - truth.bearing));
  if (turn > std::max(radians(1.5), half)) return std::nullopt;
  if (!metric) return turn;
  const double range = as_printed(tree.range);
  const double error =
      hypot_as_python(range * std::cos(bearing) - *truth.range * std::cos(truth.bearing),
                      range * std::sin(bearing) - *truth.range * std::sin(truth.bearing));
  if (error > std::max(1.0, *truth.range / 4)) return std::nullopt;
  return error;
}

std::vector<Match> match_frame(const TruthFrame& frame, std::span<const Tree> trees) {
  std::vector<Match> matches;
  for (const Tree& tree : trees) matches.push_back({.tree = &tree});
  std::stable_sort(matches.begin(), matches.end(),
                   [](const Match& a, const Match& b) { return a.tree->score > b.tree->score; });
  std::vector<bool> used(frame.trees.size());
  for (Match& match : matches) {
    std::optional<std::tuple<bool, double, std::size_t>> best;
    for (std::size_t i = 0; i < frame.trees.size(); ++i) {
      if (used[i]) continue;
      const std::optional<double> error = gated_error(frame.trees[i], *match.tree, frame.metric);
      if (!error) continue;
      const std::tuple key(frame.metric && !eligible(frame.trees[i]), *error, i);
      if (!best || key < *best) best = key;
    }
    if (!best) {
      const bool judged = !frame.metric || within_judged_range(as_printed(match.tree->range));
      if (frame.exhaustive && judged) match.verdict = Match::Verdict::false_alarm;
      continue;
    }
    const auto [passed_over, error, i] = *best;
    used[i] = true;
    match.truth = &frame.trees[i];
    match.error = error;
    if (!passed_over) match.verdict = Match::Verdict::hit;
  }
  return matches;
}

int count_wanted(const TruthFrame& frame) {
  if (!frame.metric) return static_cast<int>(frame.trees.size());
  return static_cast<int>(std::count_if(frame.trees.begin(), frame.trees.end(), eligible));
}

double trunk_overlap(const TruthTree& truth, const Tree& tree, double height) {
  const double top = std::tan(radians(25));
  const double r = *truth.range, d = truth.diameter;
  const Box t{half_width(d, r), std::tan(std::atan2(-height, std::max(r - d / 2, 0.1)))};
  const Box found{as_printed(tree.angular_width) / 2, std::tan(as_printed(tree.base_elevation))};
  const double gap = std::abs(wrap_as_python(truth.bearing - as_printed(tree.bearing)));
  const double width = std::max(0.0, std::min(t.half_width, gap + found.half_width) -
                                         std::max(-t.half_width, gap - found.half_width));
  const double tall = std::max(0.0, top - std::max(t.base, found.base));
  const double area_t = 2 * t.half_width * (top - t.base);
  const double area_found = 2 * found.half_width * (top - found.base);
  const double common = width * tall;
  return area_t > 0 && area_found > 0 ? common * common / (area_t * area_found) : 0;
}

}  // namespace bole
