#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "evaluate/evaluation.h"
#include "evaluate/image_detector.h"
#include "evaluate/plot.h"

namespace bole {

/// One detector's evaluation under its name, in its colour.
struct PlottedEvaluation {
  std::string name;
  Colour colour;
  const Evaluation* evaluation = nullptr;
  const Detections* detections = nullptr;
};

/// Writes roc.png (of panorama pixels), precision_recall.png, reliability.png,
/// position_error.png and diameter_error.png (over range) into `folder`, which is there.
void write_plots(const std::filesystem::path& folder, const Truth& truth, double min_score,
                 const std::vector<PlottedEvaluation>& evaluations);

/// Writes the panoramas of the ten frames with the most errors, worst first, as
/// worst_01_<name>.png and so on: what was found in the colour of its score, what was missed in
/// magenta, false alarms in red.
void write_worst_frames(const std::filesystem::path& folder, const Truth& truth,
                        const std::filesystem::path& images, const Detections& detections,
                        double min_score, const Camera& camera, const WarpTable& table);

}  // namespace bole
