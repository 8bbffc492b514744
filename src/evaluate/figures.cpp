#include "evaluate/figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "evaluate/matching.h"

namespace bole {
namespace {

std::vector<Tree> trees_of(const Detections& detections, const std::string& file,
                           double min_score) {
  const auto found = detections.find(file);
  std::vector<Tree> trees;
  if (found == detections.end()) return trees;
  std::copy_if(found->second.begin(), found->second.end(), std::back_inserter(trees),
               [&](const Tree& tree) { return as_printed(tree.score) >= min_score; });
  return trees;
}

double round_to_four_digits(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4f", value);
  return std::strtod(text.data(), nullptr);
}

nlohmann::ordered_json number_or_null(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

// What is measured on hits of metric frames.
struct Errors {
  std::vector<double> position, diameter, overlap;
};

// Calls visit(match) for every match, and collects the errors of the hits.
template <class Visit>
Errors visit_matches(const Truth& truth, const Detections& detections, double min_score,
                     const Visit& visit) {
  Errors errors;
  for (const TruthFrame& frame : truth.frames) {
    const std::vector<Tree> trees = trees_of(detections, frame.file, min_score);
    for (const Match& match : match_frame(frame, trees)) {
      visit(match);
      if (!frame.metric || match.verdict != Match::Verdict::hit) continue;
      errors.position.push_back(match.error);
      errors.diameter.push_back(std::abs(as_printed(match.tree->diameter) - match.truth->diameter));
      errors.overlap.push_back(trunk_overlap(*match.truth, *match.tree, truth.height));
    }
  }
  return errors;
}

void append_outcome(const Match& match, std::vector<Outcome>& outcomes) {
  if (match.verdict == Match::Verdict::ignored) return;
  outcomes.push_back({as_printed(match.tree->score), match.verdict == Match::Verdict::hit});
}

void sort_by_score(std::vector<Outcome>& outcomes) {
  std::stable_sort(outcomes.begin(), outcomes.end(),
                   [](const Outcome& a, const Outcome& b) { return a.score > b.score; });
}

double average_precision(const std::vector<RecallPrecision>& curve) {
  double area = 0, last = 0;
  for (const RecallPrecision& point : curve) {
    area += (point.recall - last) * point.precision;
    last = point.recall;
  }
  return area;
}

}  // namespace

std::optional<double> median(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

std::vector<Outcome> outcomes_of(const Truth& truth, const Detections& detections,
                                 double min_score) {
  std::vector<Outcome> outcomes;
  visit_matches(truth, detections, min_score,
                [&](const Match& match) { append_outcome(match, outcomes); });
  sort_by_score(outcomes);
  return outcomes;
}

std::vector<RecallPrecision> precision_curve(const std::vector<Outcome>& outcomes, int wanted) {
  std::vector<RecallPrecision> curve;
  int hits = 0;
  for (const Outcome& outcome : outcomes) {
    hits += outcome.hit ? 1 : 0;
    curve.push_back({static_cast<double>(hits) / std::max(1, wanted),
                     hits / (static_cast<double>(curve.size()) + 1)});
  }
  double best_after = 0;
  for (auto point = curve.rbegin(); point != curve.rend(); ++point) {
    best_after = std::max(best_after, point->precision);
    point->precision = best_after;
  }
  return curve;
}

Figures measure(const Truth& truth, const Detections& detections, double min_score) {
  std::vector<Outcome> outcomes;
  Errors errors = visit_matches(truth, detections, min_score,
                                [&](const Match& match) { append_outcome(match, outcomes); });
  sort_by_score(outcomes);
  Figures f;
  for (const TruthFrame& frame : truth.frames) f.trees += count_wanted(frame);
  for (const Outcome& outcome : outcomes) ++(outcome.hit ? f.tp : f.fp);
  f.fn = f.trees - f.tp;
  f.precision = static_cast<double>(f.tp) / std::max(1, f.tp + f.fp);
  f.recall = static_cast<double>(f.tp) / std::max(1, f.trees);
  f.f1 = 2 * f.precision * f.recall / std::max(1e-9, f.precision + f.recall);
  f.ap = average_precision(precision_curve(outcomes, f.trees));
  f.dp = median(std::move(errors.position));
  f.dw = median(std::move(errors.diameter));
  f.overlap = median(std::move(errors.overlap));
  return f;
}

std::string to_json(const Figures& f) {
  const nlohmann::ordered_json json = {{"trees", f.trees},
                                       {"tp", f.tp},
                                       {"fp", f.fp},
                                       {"fn", f.fn},
                                       {"precision", round_to_four_digits(f.precision)},
                                       {"recall", round_to_four_digits(f.recall)},
                                       {"f1", round_to_four_digits(f.f1)},
                                       {"ap", round_to_four_digits(f.ap)},
                                       {"dp_m", number_or_null(f.dp)},
                                       {"dw_m", number_or_null(f.dw)},
                                       {"overlap", number_or_null(f.overlap)}};
  return json.dump();
}

}  // namespace bole
