#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "base/errors.h"
#include "capture/replay/frame_file.h"
#include "commands/commands.h"
#include "commands/progress.h"
#include "detect/tracking/tracker.h"
#include "evaluate/annotate.h"
#include "evaluate/evaluation_plots.h"

namespace bole {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string camera, truth, folder, plots;
  double min_score = 0.5;
  bool json = false;
};

// What one detector makes of a folder's frames: each by itself, and along the drive.
struct Run {
  Detections detections, tracked;
};

// What boled makes of the frames of a drive.
class DriveTracker {
 public:
  DriveTracker(DetectorMode mode, double min_score)
      : tracker_(mode == DetectorMode::bole ? Tracker::Scores::probabilities
                                            : Tracker::Scores::ranks),
        least_score_(mode == DetectorMode::bole ? 0 : min_score) {}

  /// `alone`: the panorama's trees by itself.
  std::vector<Tree> detect(ImageDetector& detector, const TruthFrame& frame,
                           const PanoramaView& panorama, const std::vector<Tree>& alone) {
    if (frame.world != world_) tracker_.reset();
    const double elapsed = static_cast<double>(frame.utime - utime_) * 1e-6;
    world_ = frame.world;
    utime_ = frame.utime;
    std::vector<Tree> trees = alone;
    if (const auto expected = tracker_.expected(elapsed); !expected.empty()) {
      const std::span<const Tree> found = detector.detect(panorama, expected);
      trees.assign(found.begin(), found.end());
    }
    std::erase_if(trees, [&](const Tree& tree) { return tree.score < least_score_; });
    trees.resize(std::min(trees.size(), Tracker::kMostTrees));
    tracker_.update(trees, elapsed);
    return trees;
  }

 private:
  Tracker tracker_;
  double least_score_;
  int world_ = 0;
  std::int64_t utime_ = 0;
};

Run run(ImageDetector& detector, DetectorMode mode, const Truth& truth, const Options& options) {
  Run result;
  DriveTracker tracker(mode, options.min_score);
  FrameReader reader(detector.table().image_size());
  FrameSlot slot;
  int done = 0;
  for (const TruthFrame& frame : truth.frames) {
    const fs::path file = fs::path(options.folder) / frame.file;
    try {
      reader.read(file, slot);
      const PanoramaView panorama = detector.warp(slot.view());
      const std::span<const Tree> trees = detector.detect(panorama);
      std::vector<Tree>& alone = result.detections[frame.file];
      alone.assign(trees.begin(), trees.end());
      result.tracked[frame.file] = tracker.detect(detector, frame, panorama, alone);
    } catch (const std::runtime_error& error) {
      throw ConfigError(file.string(), "", error.what(), "every frame of the truth is needed");
    }
    show_progress(++done, static_cast<int>(truth.frames.size()));
  }
  return result;
}

void eval(const Options& options) {
  const Truth truth = read_truth(options.truth);
  if (truth.frames.empty()) throw ConfigError(options.truth, "frames", "is empty", "");
  ImageDetector ours(options.camera, DetectorMode::bole);
  ImageDetector paper(options.camera, DetectorMode::paper);
  if (!options.plots.empty()) prepare_folder("--plots", options.plots);
  const Run our_run = run(ours, DetectorMode::bole, truth, options);
  const Run paper_run = run(paper, DetectorMode::paper, truth, options);
  const auto evaluated = [&](const Run& r) {
    return evaluate(truth, r.detections, r.tracked, ours.table().panorama(), options.min_score);
  };
  const Evaluation our_figures = evaluated(our_run), paper_figures = evaluated(paper_run);
  if (options.json) {
    std::printf("{\"bole\":%s,\"paper\":%s}\n", to_json(our_figures).c_str(),
                to_json(paper_figures).c_str());
  } else {
    std::puts(to_table({{"bole", our_figures}, {"paper", paper_figures}}).c_str());
  }
  if (options.plots.empty()) return;
  write_plots(options.plots, truth, options.min_score,
              {{"bole", kOurs, &our_figures, &our_run.detections},
               {"paper", kPaper, &paper_figures, &paper_run.detections}});
  write_worst_frames(options.plots, truth, options.folder, our_run.detections, options.min_score,
                     ours.camera(), ours.table());
}

}  // namespace

void add_eval(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("eval", "Measures both detectors on frames whose trees are known");
  command->add_option("--camera", options->camera, "camera.toml of the camera that took them")
      ->type_name("FILE")
      ->required();
  command->add_option("--truth", options->truth, "truth.json, as bolectl sim writes it")
      ->type_name("FILE")
      ->required();
  command
      ->add_option("--plots", options->plots,
                   "Folder for the curves and the ten worst frames, as PNG")
      ->type_name("FOLDER");
  command
      ->add_option("--min-score", options->min_score,
                   "The score from which on a tree counts; AP is over all")
      ->type_name("SCORE")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command->add_flag("--json", options->json, "Print one line of JSON");
  command->add_option("DIR", options->folder, "Folder of the frames")->type_name("")->required();
  command->callback([options] { eval(*options); });
}

}  // namespace bole
