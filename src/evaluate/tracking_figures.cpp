#include "evaluate/tracking_figures.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "detect/tracking/assignment.h"
#include "evaluate/matching.h"

namespace bole {
namespace {

using IdPair = std::pair<int, int>;

double distance(const TruthTree& a, const TruthTree& b) {
  return std::hypot(*a.range * std::cos(a.bearing) - *b.range * std::cos(b.bearing),
                    *a.range * std::sin(a.bearing) - *b.range * std::sin(b.bearing));
}

// Counts what a drive's frames bring, one after the other. Ids of trees hold within one world.
class Drive {
 public:
  void add(const TruthFrame& frame, const std::vector<Tree>& trees) {
    for (const TruthTree& truth : frame.trees) {
      if (eligible(truth)) ++wanted_;
    }
    for (const Match& match : match_frame(frame, trees)) {
      if (match.verdict == Match::Verdict::ignored) continue;
      ++found_;
      for (const TruthTree& truth : frame.trees) {
        if (eligible(truth) && gated_error(truth, *match.tree, true)) {
          ++together_[{truth.id, match.tree->id}];
        }
      }
      if (match.verdict == Match::Verdict::hit) follow(frame, match);
    }
  }

  int wanted() const { return wanted_; }
  int found() const { return found_; }
  int id_switches() const { return id_switches_; }
  int id_swaps() const { return id_swaps_; }

  /// The most hits of a one-to-one pairing of true with found ids.
  int best_pairing() const {
    std::map<int, int> rows, columns;
    int most = 1;
    for (const auto& [ids, count] : together_) {
      rows.emplace(ids.first, static_cast<int>(rows.size()));
      columns.emplace(ids.second, static_cast<int>(columns.size()));
      most = std::max(most, count);
    }
    const int width = static_cast<int>(columns.size());
    std::vector<int> counts(rows.size() * columns.size());
    for (const auto& [ids, count] : together_) {
      counts[rows[ids.first] * width + columns[ids.second]] = count;
    }
    std::vector<double> costs(counts.size());
    std::transform(counts.begin(), counts.end(), costs.begin(),
                   [most](int count) { return most - count; });
    int sum = 0, row = 0;
    Assignment assignment;
    for (const int column : assignment.solve(costs, static_cast<int>(rows.size()), width, most)) {
      if (column >= 0) sum += counts[row * width + column];
      ++row;
    }
    return sum;
  }

 private:
  void follow(const TruthFrame& frame, const Match& match) {
    const int true_id = match.truth->id, found_id = match.tree->id;
    const auto [last_found, new_tree] = found_id_of_.try_emplace(true_id, found_id);
    if (!new_tree && last_found->second != found_id) ++id_switches_;
    last_found->second = found_id;

    const auto [last_true, new_id] = true_id_of_.try_emplace(found_id, true_id);
    if (!new_id && last_true->second != true_id) {
      for (const TruthTree& before : frame.trees) {
        if (before.id == last_true->second && distance(before, *match.truth) > 1) ++id_swaps_;
      }
    }
    last_true->second = true_id;
  }

  int wanted_ = 0, found_ = 0, id_switches_ = 0, id_swaps_ = 0;
  std::map<IdPair, int> together_;
  std::map<int, int> found_id_of_, true_id_of_;
};

}  // namespace

TrackingFigures measure_tracking(const Truth& truth, const Detections& tracked, double min_score) {
  std::map<int, Drive> drives;  // by world
  for (const TruthFrame& frame : truth.frames) {
    std::vector<Tree> trees;
    if (const auto found = tracked.find(frame.file); found != tracked.end()) {
      std::copy_if(found->second.begin(), found->second.end(), std::back_inserter(trees),
                   [&](const Tree& tree) { return tree.score >= min_score; });
    }
    if (frame.metric) drives[frame.world].add(frame, trees);
  }
  TrackingFigures figures;
  int pairs = 0, all = 0;
  for (const auto& [world, drive] : drives) {
    pairs += drive.best_pairing();
    all += drive.wanted() + drive.found();
    figures.id_switches += drive.id_switches();
    figures.id_swaps += drive.id_swaps();
  }
  figures.idf1 = 2.0 * pairs / std::max(1, all);
  return figures;
}

}  // namespace bole
