#include "evaluate/evaluation_plots.h"

#include <algorithm>
#include <cmath>

#include "evaluate/annotate.h"
#include "evaluate/matching.h"

namespace bole {
namespace {

using Points = std::vector<cv::Point2d>;

Plot plot_roc(const std::vector<PlottedEvaluation>& evaluations) {
  double most = 0.02;
  for (const auto& [name, colour, evaluation, detections] : evaluations) {
    most = std::max(most, evaluation->pixels.curve.back().false_positive_rate * 1.05);
  }
  Plot plot("Panorama pixels of trunks, over the threshold of the score",
            {"false-positive rate", 0, std::min(most, 1.0)}, {"true-positive rate"});
  for (const auto& [name, colour, evaluation, detections] : evaluations) {
    Points points;
    for (const PixelRates::Point& p : evaluation->pixels.curve) {
      points.emplace_back(p.false_positive_rate, p.true_positive_rate);
    }
    plot.add_line(points, colour, name);
  }
  return plot;
}

Plot plot_precision(const std::vector<PlottedEvaluation>& evaluations) {
  Plot plot("Precision over recall", {"recall"}, {"precision"});
  for (const auto& [name, colour, evaluation, detections] : evaluations) {
    Points points;
    for (const RecallPrecision& p : evaluation->precision) {
      points.emplace_back(p.recall, p.precision);
    }
    if (!points.empty()) points.insert(points.begin(), {0, points.front().y});
    plot.add_line(points, colour, name + ", AP " + fixed(evaluation->ap_of_all, 3));
  }
  return plot;
}

Plot plot_reliability(const std::vector<PlottedEvaluation>& evaluations) {
  Plot plot("Is the score a probability?", {"mean score of the bin"}, {"share of true trees"});
  plot.add_line({{0, 0}, {1, 1}}, kGuide, "perfect");
  for (const auto& [name, colour, evaluation, detections] : evaluations) {
    Points points;
    for (const Reliability::Bin& bin : evaluation->reliability.bins) {
      if (bin.count > 0) points.emplace_back(bin.mean_score, bin.hit_share);
    }
    plot.add_line(
        points, colour,
        name + ", calibration error " + fixed(evaluation->reliability.calibration_error, 3), true);
  }
  return plot;
}

struct RangedError {
  double range, position, diameter;
};

std::vector<RangedError> errors_of(const Truth& truth, const Detections& detections,
                                   double min_score) {
  std::vector<RangedError> errors;
  for (const TruthFrame& frame : truth.frames) {
    const auto found = detections.find(frame.file);
    if (!frame.metric || found == detections.end()) continue;
    for (const Match& match : match_frame(frame, found->second)) {
      if (match.verdict != Match::Verdict::hit || match.tree->score < min_score) continue;
      errors.push_back({*match.truth->range, match.error,
                        std::abs(match.tree->diameter - match.truth->diameter)});
    }
  }
  return errors;
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[std::lround(share * (static_cast<double>(values.size()) - 1))];
}

// For each metre of range a bar from the lower to the upper quartile and a line at the median.
template <class Error>
Plot plot_errors(
    const std::string& title, const std::string& axis, double most,
    const std::vector<std::pair<const PlottedEvaluation*, std::vector<RangedError>>>& evaluations,
    const Error& error) {
  Plot plot(title, {"range, m: bars from quartile to quartile, lines at medians", 1, 8},
            {axis, 0, most});
  const double width = 0.8 / static_cast<double>(evaluations.size());
  double left = 0.1;
  for (const auto& [plotted, errors] : evaluations) {
    std::string name = plotted->name;
    for (int metre = 1; metre < 8; ++metre) {
      std::vector<double> values;
      for (const RangedError& e : errors) {
        if (std::min(static_cast<int>(e.range), 7) == metre) values.push_back(error(e));
      }
      if (values.empty()) continue;
      const double x = metre + left, middle = quantile(values, 0.5);
      plot.add_bar({x, quantile(values, 0.25)}, {x + width * 0.9, quantile(values, 0.75)},
                   plotted->colour * 0.5 + Colour::all(127), "");
      plot.add_line({{x, middle}, {x + width * 0.9, middle}}, plotted->colour, name);
      name.clear();
    }
    left += width;
  }
  return plot;
}

int errors_in(const TruthFrame& frame, const Detections& detections, double min_score) {
  int wrong = count_wanted(frame);
  const auto found = detections.find(frame.file);
  if (found == detections.end()) return wrong;
  for (const Match& match : match_frame(frame, found->second)) {
    if (match.tree->score < min_score) continue;
    if (match.verdict == Match::Verdict::hit) --wrong;
    if (match.verdict == Match::Verdict::false_alarm) ++wrong;
  }
  return wrong;
}

TrunkMark mark_of_truth(const TruthTree& tree, bool metric, double height) {
  const Colour magenta(255, 60, 255);
  if (!metric) {
    return {tree.bearing, tree.angular_width, tree.base_elevation, magenta, {"missed"}};
  }
  return {tree.bearing,
          2 * std::asin(std::min(0.99, tree.diameter / 2 / *tree.range)),
          std::atan2(-height, std::max(*tree.range - tree.diameter / 2, 0.1)),
          magenta,
          {"missed", fixed(*tree.range, 1) + " m"}};
}

// What was found, wrongly found and missed in a frame.
std::vector<TrunkMark> judged_marks(const TruthFrame& frame, std::span<const Tree> trees,
                                    double min_score, double height) {
  std::vector<TrunkMark> marks;
  std::vector<const TruthTree*> hit;
  for (const Match& match : match_frame(frame, trees)) {
    if (match.tree->score < min_score) continue;
    TrunkMark mark = mark_of(*match.tree);
    if (match.verdict == Match::Verdict::false_alarm) {
      mark.colour = {60, 60, 255};
      mark.labels.push_back("false alarm");
    }
    marks.push_back(mark);
    hit.push_back(match.truth);
  }
  for (const TruthTree& tree : frame.trees) {
    const bool wanted = !frame.metric || eligible(tree);
    if (wanted && std::find(hit.begin(), hit.end(), &tree) == hit.end()) {
      marks.push_back(mark_of_truth(tree, frame.metric, height));
    }
  }
  return marks;
}

}  // namespace

void write_plots(const std::filesystem::path& folder, const Truth& truth, double min_score,
                 const std::vector<PlottedEvaluation>& evaluations) {
  write_picture(folder / "roc.png", plot_roc(evaluations).picture());
  write_picture(folder / "precision_recall.png", plot_precision(evaluations).picture());
  write_picture(folder / "reliability.png", plot_reliability(evaluations).picture());
  std::vector<std::pair<const PlottedEvaluation*, std::vector<RangedError>>> errors;
  errors.reserve(evaluations.size());
  for (const PlottedEvaluation& plotted : evaluations) {
    errors.emplace_back(&plotted, errors_of(truth, *plotted.detections, min_score));
  }
  write_picture(folder / "position_error.png",
                plot_errors("Error in position", "m", 1, errors, [](const RangedError& e) {
                  return e.position;
                }).picture());
  write_picture(folder / "diameter_error.png",
                plot_errors("Error in diameter", "m", 0.3, errors, [](const RangedError& e) {
                  return e.diameter;
                }).picture());
}

void write_worst_frames(const std::filesystem::path& folder, const Truth& truth,
                        const std::filesystem::path& images, const Detections& detections,
                        double min_score, const Camera& camera, const WarpTable& table) {
  std::vector<std::pair<int, const TruthFrame*>> frames;
  for (const TruthFrame& frame : truth.frames) {
    frames.emplace_back(errors_in(frame, detections, min_score), &frame);
  }
  std::stable_sort(frames.begin(), frames.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  for (std::size_t k = 0; k < std::min<std::size_t>(10, frames.size()); ++k) {
    const TruthFrame& frame = *frames[k].second;
    const auto found = detections.find(frame.file);
    if (frames[k].first == 0 || found == detections.end()) continue;
    char rank[32];
    (void)std::snprintf(rank, sizeof rank, "worst_%02d_", static_cast<int>(k) + 1);
    write_picture(
        folder / (rank + std::filesystem::path(frame.file).stem().string() + ".png"),
        draw_panorama(camera, table, read_picture(images / frame.file, table.image_size()),
                      judged_marks(frame, found->second, min_score, truth.height)));
  }
}

}  // namespace bole
