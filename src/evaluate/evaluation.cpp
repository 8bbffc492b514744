#include "evaluate/evaluation.h"

#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "evaluate/drawing.h"

namespace bole {
namespace {

// The rates at the least score that is not below `min_score`.
PixelRates::Point rates_at(const PixelRates& rates, double min_score) {
  PixelRates::Point last;
  for (const PixelRates::Point& point : rates.curve) {
    if (point.min_score < min_score - 1e-9) break;
    last = point;
  }
  return last;
}

bool have_ids(const Truth& truth) {
  return std::any_of(truth.frames.begin(), truth.frames.end(), [](const TruthFrame& frame) {
    return frame.metric && !frame.trees.empty() && frame.trees.front().id >= 0;
  });
}

std::string text(const std::optional<double>& value, int digits) {
  return value ? fixed(*value, digits) : "-";
}

// name and text of each figure
std::vector<std::pair<std::string, std::string>> lines_of(const Evaluation& e) {
  const Figures& f = e.figures;
  const PixelRates::Point pixels = rates_at(e.pixels, e.min_score);
  std::vector<std::pair<std::string, std::string>> lines = {
      {"trees to find", std::to_string(f.trees)},
      {"found", std::to_string(f.tp)},
      {"false alarms", std::to_string(f.fp)},
      {"precision", fixed(f.precision, 4)},
      {"recall", fixed(f.recall, 4)},
      {"F1", fixed(f.f1, 4)},
      {"AP over all scores", fixed(e.ap_of_all, 4)},
      {"position error, median, m", text(f.dp, 3)},
      {"diameter error, median, m", text(f.dw, 3)},
      {"overlap, median", text(f.overlap, 3)},
      {"calibration error", fixed(e.reliability.calibration_error, 3)},
      {"range within 2 sigma", fixed(e.range_trust.share_within_2_sigma, 3)},
      {"pixels: true-positive rate", fixed(pixels.true_positive_rate, 3)},
      {"pixels: false-positive rate", fixed(pixels.false_positive_rate, 4)},
      {"pixels: overlap, median of frames", text(e.pixels.overlap, 3)}};
  if (e.tracked) {
    const TrackedEvaluation& t = *e.tracked;
    lines.insert(lines.end(),
                 {{"tracked: IDF1", fixed(t.ids.idf1, 3)},
                  {"tracked: id switches", std::to_string(t.ids.id_switches)},
                  {"tracked: id swaps over 1 m", std::to_string(t.ids.id_swaps)},
                  {"tracked: precision", fixed(t.figures.precision, 4)},
                  {"tracked: recall", fixed(t.figures.recall, 4)},
                  {"tracked: position error, median, m", text(t.figures.dp, 3)},
                  {"tracked: diameter error, median, m", text(t.figures.dw, 3)},
                  {"tracked: calibration error", fixed(t.calibration_error, 3)},
                  {"tracked: range within 2 sigma", fixed(t.range_trust.share_within_2_sigma, 3)}});
  }
  return lines;
}

}  // namespace

Evaluation evaluate(const Truth& truth, const Detections& detections, const Detections& tracked,
                    const PanoramaGeometry& panorama, double min_score) {
  Evaluation e;
  e.min_score = min_score;
  e.figures = measure(truth, detections, min_score);
  e.ap_of_all = measure(truth, detections, 0).ap;
  const std::vector<Outcome> outcomes = outcomes_of(truth, detections, 0);
  e.precision = precision_curve(outcomes, e.figures.trees);
  e.reliability = measure_reliability(outcomes);
  e.range_trust = measure_range_trust(truth, detections, min_score);
  e.pixels = measure_pixel_rates(truth, detections, panorama, min_score);
  if (have_ids(truth)) {
    e.tracked = {measure_tracking(truth, tracked, min_score), measure(truth, tracked, min_score),
                 measure_reliability(outcomes_of(truth, tracked, 0)).calibration_error,
                 measure_range_trust(truth, tracked, min_score)};
  }
  return e;
}

std::string to_json(const Evaluation& e) {
  auto json = nlohmann::ordered_json::parse(to_json(e.figures));
  const PixelRates::Point pixels = rates_at(e.pixels, e.min_score);
  json["ap_of_all"] = e.ap_of_all;
  json["calibration_error"] = e.reliability.calibration_error;
  for (const Reliability::Bin& bin : e.reliability.bins)
    json["reliability"].push_back({bin.count, bin.mean_score, bin.hit_share});
  json["range_within_2_sigma"] = e.range_trust.share_within_2_sigma;
  json["pixel_true_positive_rate"] = pixels.true_positive_rate;
  json["pixel_false_positive_rate"] = pixels.false_positive_rate;
  json["pixel_overlap"] =
      e.pixels.overlap ? nlohmann::ordered_json(*e.pixels.overlap) : nlohmann::ordered_json();
  if (e.tracked) {
    auto tracked = nlohmann::ordered_json::parse(to_json(e.tracked->figures));
    tracked["idf1"] = e.tracked->ids.idf1;
    tracked["id_switches"] = e.tracked->ids.id_switches;
    tracked["id_swaps"] = e.tracked->ids.id_swaps;
    tracked["calibration_error"] = e.tracked->calibration_error;
    tracked["range_within_2_sigma"] = e.tracked->range_trust.share_within_2_sigma;
    json["tracked"] = tracked;
  }
  return json.dump();
}

std::string to_table(const std::vector<std::pair<std::string, Evaluation>>& evaluations) {
  char cell[64];
  const auto left = [&](const std::string& name) {
    (void)std::snprintf(cell, sizeof cell, "%-36s", name.c_str());
    return std::string(cell);
  };
  const auto right = [&](const std::string& value) {
    (void)std::snprintf(cell, sizeof cell, "%10s", value.c_str());
    return std::string(cell);
  };
  std::string table = left("");
  for (const auto& [name, evaluation] : evaluations) table += right(name);
  const std::size_t lines = lines_of(evaluations.front().second).size();
  for (std::size_t k = 0; k < lines; ++k) {
    table += "\n" + left(lines_of(evaluations.front().second)[k].first);
    for (const auto& [name, evaluation] : evaluations)
      table += right(lines_of(evaluation)[k].second);
  }
  return table;
}

}  // namespace bole
