#include "evaluate/figures.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "geometry/angles.h"

namespace bole {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

Detections parse_detections(const std::string& text) {
  Detections detections;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const json value = json::parse(line);
    std::vector<Tree>& trees = detections[value["file"]];
    for (const json& tree : value["trees"]) {
      trees.push_back({.bearing = tree["bearing"],
                       .range = tree["range"],
                       .diameter = tree["diameter"],
                       .score = tree["score"],
                       .base_elevation = tree["base_elevation"],
                       .angular_width = tree["angular_width"]});
    }
  }
  return detections;
}

void expect_same(const json& ours, const json& theirs, const std::string& what) {
  ASSERT_EQ(ours.size(), theirs.size()) << what;
  for (const auto& [key, value] : theirs.items()) EXPECT_EQ(ours.at(key), value) << what << key;
}

// Random frames with what makes scoring hard: trees on the limits of what is judged, hidden ones,
// bearings at the seam, equal scores, double detections, empty frames.
class RandomCase {
 public:
  explicit RandomCase(int seed) : random_(static_cast<unsigned>(seed)) {
    const bool metric = seed % 4 != 3;
    truth_ = {{"height_m", uniform(0.4, 1.6)}, {"frames", json::array()}};
    if (seed % 2 == 0) truth_["metric"] = metric;
    for (int k = 0; k < 6; ++k) add_frame("frame" + std::to_string(k) + ".png", metric);
  }
  const json& truth() const { return truth_; }
  const Detections& detections() const { return detections_; }

 private:
  double uniform(double low, double high) {
    return std::uniform_real_distribution(low, high)(random_);
  }
  int below(int n) { return std::uniform_int_distribution(0, n - 1)(random_); }

  void add_frame(const std::string& file, bool metric) {
    json frame = {{"file", file}, {"trees", json::array()}};
    if (below(4) == 0) frame["exhaustive"] = false;
    std::vector<Tree>& found = detections_[file];
    for (int k = below(14); k > 0; --k) {
      const double bearing = below(5) == 0 ? kPi - uniform(0, 0.02) : uniform(-kPi, kPi);
      const double range = below(5) == 0 ? 8 : uniform(0.8, 10);
      const double diameter = below(6) == 0 ? 0.2 : uniform(0.15, 0.9);
      frame["trees"].push_back(tree(metric, bearing, range, diameter));
      for (int d = below(3); d > 0; --d) found.push_back(near(bearing, range, diameter));
    }
    for (int k = below(4); k > 0; --k) found.push_back(near(uniform(-kPi, kPi), 4, 0.5));
    if (below(6) == 0) found.clear();
    truth_["frames"].push_back(frame);
  }

  json tree(bool metric, double bearing, double range, double diameter) {
    if (!metric) {
      return {{"bearing", bearing}, {"base_elevation", -0.2}, {"angular_width", diameter / range}};
    }
    return {{"bearing", bearing},
            {"range", range},
            {"diameter", diameter},
            {"visible", below(4) == 0 ? 0.5 : uniform(0, 1)}};
  }

  Tree near(double bearing, double range, double diameter) {
    const double b = wrap_angle(bearing + uniform(-0.06, 0.06));
    const double r = range + uniform(-1.2, 1.2);
    const double d = std::max(0.05, diameter + uniform(-0.2, 0.2));
    return {.bearing = static_cast<float>(b),
            .range = static_cast<float>(r),
            .diameter = static_cast<float>(d),
            .score = static_cast<float>(below(20)) / 20,
            .base_elevation = static_cast<float>(uniform(-0.9, 0.1)),
            .angular_width = static_cast<float>(d / std::max(r, 0.3))};
  }

  std::mt19937 random_;
  json truth_;
  Detections detections_;
};

std::string output_of(const std::string& command) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  std::array<char, 4096> part{};
  while (std::fgets(part.data(), part.size(), pipe.get())) text += part.data();
  return text;
}

// Scores the cases 0.json, 1.json .. of a folder, each with its truth and its lines; prints a line
// a case and threshold.
constexpr const char* kScoreCases = R"(
import json, sys
sys.path.insert(0, sys.argv[1])
import score
for case in range(int(sys.argv[3])):
    value = json.load(open(f'{sys.argv[2]}/{case}.json'))
    lines = {line['file']: line['trees'] for line in value['lines']}
    for min_score in (0, 0.5):
        print(json.dumps(score.score(value['truth'], lines, min_score)))
)";

TEST(Figures, EqualThoseOfTheScoringTool) {
  const fs::path tools = fs::path(BOLE_SHARED_DIR) / "tools";
  if (!fs::exists(tools / "score.py"))
    GTEST_SKIP() << tools / "score.py"
                 << " is not there";
  const fs::path folder = fs::path(testing::TempDir()) / "figures_test";
  fs::create_directories(folder);
  constexpr int kCases = 40;
  for (int k = 0; k < kCases; ++k) {
    const RandomCase random(k);
    json lines = json::array();
    for (const auto& [file, trees] : random.detections()) {
      lines.push_back(json::parse(detection_line(file, trees)));
    }
    std::ofstream(folder / (std::to_string(k) + ".json"))
        << json{{"truth", random.truth()}, {"lines", lines}};
  }
  std::ofstream(folder / "score_cases.py") << kScoreCases;
  std::istringstream theirs(output_of("python3 -B '" + (folder / "score_cases.py").string() +
                                      "' '" + tools.string() + "' '" + folder.string() + "' " +
                                      std::to_string(kCases)));
  for (int k = 0; k < kCases; ++k) {
    const RandomCase random(k);
    const Truth truth = parse_truth(random.truth().dump(), "case");
    for (const double min_score : {0.0, 0.5}) {
      std::string line;
      ASSERT_TRUE(std::getline(theirs, line));
      expect_same(json::parse(to_json(measure(truth, random.detections(), min_score))),
                  json::parse(line), "case " + std::to_string(k) + " ");
    }
  }
}

// Written by tools/score.py from the truth and the lines beside it.
TEST(Figures, EqualTheGoldenOnes) {
  const fs::path folder = fs::path(BOLE_SOURCE_DIR) / "tests/golden/score";
  const Truth truth = read_truth(folder / "truth.json");
  const Detections found = parse_detections(read_text_file(folder / "detections.jsonl", 1 << 20));
  const json golden = json::parse(read_text_file(folder / "figures.json", 1 << 20));
  expect_same(json::parse(to_json(measure(truth, found, 0))), golden["0"], "all ");
  expect_same(json::parse(to_json(measure(truth, found, 0.5))), golden["0.5"], "best ");
}

TEST(Figures, OfNothingAreNothing) {
  const Figures figures = measure({}, {}, 0);
  EXPECT_EQ(figures.trees, 0);
  EXPECT_EQ(figures.f1, 0);
  EXPECT_EQ(figures.ap, 0);
  EXPECT_FALSE(figures.dp.has_value());
}

}  // namespace
}  // namespace bole
