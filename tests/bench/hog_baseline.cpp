// The paper's machine-learning baseline: histograms of oriented gradients and a linear support
// vector machine, OpenCV's defaults, trained on trunks of some frames against background of the
// same, and measured on others.
//
// usage: hog_baseline TRAIN_CAMERA.toml TRAIN_DIR TEST_CAMERA.toml TEST_DIR
//
// Each folder holds frames and their truth.json. A score of 0.5 is the threshold with the best F1
// on the frames that it learnt from. Prints the figures of the test frames at a score
// of 0.5, as tools/score.py names them, and the average precision over all scores.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/ml.hpp>
#include <opencv2/objdetect.hpp>

#include "evaluate/figures.h"
#include "evaluate/image_detector.h"
#include "evaluate/matching.h"
#include "geometry/ground.h"

namespace bole {
namespace {

namespace fs = std::filesystem;

constexpr int kMargin = 280;      // panorama columns that are repeated behind the seam
constexpr double kEnlarged = 3;   // the smallest window, 64 pixels, then holds a trunk of 11
constexpr int kPatches = 16;      // of background, from each frame
constexpr int kMostTrunks = 700;  // to learn from
constexpr double kLeastMargin = -0.6;
constexpr std::size_t kFramesForThreshold = 20;

// A frame's green panorama, its ends repeated behind the seam.
class Panorama {
 public:
  Panorama(ImageDetector& images, const fs::path& file) : geometry_(images.table().panorama()) {
    const PanoramaView view = images.warp(view_of(read_picture(file)));
    const cv::Mat1b green(geometry_.rows, geometry_.width, const_cast<std::uint8_t*>(view.pixels),
                          view.stride);
    cv::copyMakeBorder(green, pixels_, 0, 0, kMargin, kMargin, cv::BORDER_WRAP);
  }

  const cv::Mat1b& pixels() const { return pixels_; }

  /// The window around a trunk: twice as wide and four times as tall as the trunk is wide, with
  /// half a trunk's width of ground under the foot.
  cv::Rect2d window(double bearing, double foot_tangent, double angular_width) const {
    const double w = angular_width * geometry_.focal();
    return {geometry_.column_of_bearing(bearing) + kMargin - w,
            geometry_.row_of_tangent(foot_tangent) - 3.5 * w, 2 * w, 4 * w};
  }

  /// The trunk that stands in a window; none where its foot is on no ground.
  std::optional<Tree> tree_in(const cv::Rect2d& window, double height) const {
    const double w = window.width / 2;
    const double tangent = geometry_.tangent_of_row(window.y + window.height - w / 2);
    const double column = window.x + w - kMargin;
    if (tangent >= 0 || column < 0 || column >= geometry_.width) return std::nullopt;
    const double foot = ground_distance(tangent, height);
    const double angle = w / geometry_.focal(), diameter = diameter_from_foot(foot, angle);
    return Tree{.bearing = static_cast<float>(geometry_.bearing_of_column(column)),
                .range = static_cast<float>(foot + diameter / 2),
                .diameter = static_cast<float>(diameter),
                .base_elevation = static_cast<float>(std::atan(tangent)),
                .angular_width = static_cast<float>(angle)};
  }

  cv::Mat1b patch(const cv::Rect2d& window, cv::Size size) const {
    cv::Mat1b out;
    cv::Matx23d map(window.width / size.width, 0, window.x, 0, window.height / size.height,
                    window.y);
    cv::warpAffine(pixels_, out, map, size, cv::INTER_AREA | cv::WARP_INVERSE_MAP,
                   cv::BORDER_REPLICATE);
    return out;
  }

 private:
  const PanoramaGeometry& geometry_;
  cv::Mat1b pixels_;
};

struct Samples {
  cv::Mat1f features;
  cv::Mat1i labels;
  int trunks = 0;

  void add(const cv::HOGDescriptor& hog, const cv::Mat1b& patch, int label) {
    std::vector<float> values;
    hog.compute(patch, values);
    features.push_back(cv::Mat1f(values).reshape(1, 1));
    labels.push_back(label);
    trunks += label == 1 ? 1 : 0;
  }
};

void add_frame(Samples& samples, const cv::HOGDescriptor& hog, const Panorama& panorama,
               const TruthFrame& frame, double height, cv::RNG& rng) {
  std::vector<cv::Rect2d> trunks;
  for (const TruthTree& tree : frame.trees) {
    const double foot = std::max(*tree.range - tree.diameter / 2, 0.5);
    trunks.push_back(panorama.window(tree.bearing, ground_tangent(foot, height),
                                     angular_width(tree.diameter, *tree.range)));
    if (eligible(tree)) samples.add(hog, panorama.patch(trunks.back(), hog.winSize), 1);
  }
  for (int k = 0; k < kPatches; ++k) {
    const double width = std::exp(rng.uniform(std::log(12.0), std::log(200.0)));
    const cv::Rect2d window(rng.uniform(0.0, panorama.pixels().cols - width),
                            rng.uniform(-width, panorama.pixels().rows - width), width, 2 * width);
    const bool on_trunk = std::any_of(trunks.begin(), trunks.end(), [&](const cv::Rect2d& trunk) {
      return (trunk & window).area() > 0.2 * std::min(trunk.area(), window.area());
    });
    if (!on_trunk) samples.add(hog, panorama.patch(window, hog.winSize), -1);
  }
}

// The separating plane, as HOGDescriptor wants it: weights, then the offset.
std::vector<float> train(const Samples& samples) {
  const cv::Ptr<cv::ml::SVM> svm = cv::ml::SVM::create();
  svm->setType(cv::ml::SVM::EPS_SVR);  // as OpenCV's own example trains pedestrians
  svm->setKernel(cv::ml::SVM::LINEAR);
  svm->setC(0.01);
  svm->setP(0.1);
  svm->setTermCriteria({cv::TermCriteria::MAX_ITER + cv::TermCriteria::EPS, 1000, 1e-3});
  svm->train(samples.features, cv::ml::ROW_SAMPLE, samples.labels);
  cv::Mat alpha, index;
  const double offset = svm->getDecisionFunction(0, alpha, index);
  const cv::Mat1f normal = svm->getSupportVectors();
  std::vector<float> plane(normal.begin(), normal.end());
  plane.push_back(static_cast<float>(-offset));
  return plane;
}

// What was learnt: where the plane lies, and how far from it a window is a trunk.
struct Hog {
  cv::HOGDescriptor descriptor;
  double threshold = 0;
};

std::vector<Tree> detect(const Hog& hog, const Panorama& panorama, const Camera& camera) {
  cv::Mat1b enlarged;
  cv::resize(panorama.pixels(), enlarged, {}, kEnlarged, kEnlarged, cv::INTER_LINEAR);
  std::vector<cv::Rect> windows;
  std::vector<double> margins;
  hog.descriptor.detectMultiScale(enlarged, windows, margins, kLeastMargin, {8, 8}, {0, 0}, 1.1, 0);
  std::vector<Tree> trees;
  const Search& search = camera.config.search;
  for (std::size_t k = 0; k < windows.size(); ++k) {
    const cv::Rect2d window(windows[k].x / kEnlarged, windows[k].y / kEnlarged,
                            windows[k].width / kEnlarged, windows[k].height / kEnlarged);
    std::optional<Tree> tree = panorama.tree_in(window, camera.config.mount.height);
    if (!tree || tree->range < search.range.low || tree->range > search.range.high * 1.1 ||
        tree->diameter < search.diameter.low * 0.75 ||
        tree->diameter > search.diameter.high * 1.25) {
      continue;
    }
    tree->score = static_cast<float>(1 / (1 + std::exp(-3 * (margins[k] - hog.threshold))));
    trees.push_back(*tree);
  }
  // Best first; what stands in a better one's bearing goes.
  std::sort(trees.begin(), trees.end(),
            [](const Tree& a, const Tree& b) { return a.score > b.score; });
  std::vector<Tree> kept;
  for (const Tree& tree : trees) {
    const bool taken = std::any_of(kept.begin(), kept.end(), [&](const Tree& better) {
      return std::abs(std::remainder(tree.bearing - better.bearing, 2 * CV_PI)) <
             std::max(tree.angular_width, better.angular_width) / 2;
    });
    if (!taken) kept.push_back(tree);
  }
  return kept;
}

Detections detect_in(const Hog& hog, ImageDetector& images, const fs::path& folder,
                     const Truth& truth) {
  Detections detections;
  for (const TruthFrame& frame : truth.frames) {
    detections[frame.file] = detect(hog, Panorama(images, folder / frame.file), images.camera());
  }
  return detections;
}

// The threshold with the best F1 on the frames of a folder.
double best_threshold(const Hog& hog, ImageDetector& images, const fs::path& folder, Truth truth) {
  truth.frames.resize(std::min<std::size_t>(truth.frames.size(), kFramesForThreshold));
  const Detections detections = detect_in(hog, images, folder, truth);
  double best_f1 = 0, best = 0;
  for (double threshold = kLeastMargin; threshold < 2; threshold += 0.02) {
    const double f1 = measure(truth, detections, 1 / (1 + std::exp(-3 * threshold))).f1;
    if (f1 > best_f1) best_f1 = f1, best = threshold;
  }
  return best;
}

Hog learn(const fs::path& camera, const fs::path& folder) {
  ImageDetector images(camera, DetectorMode::paper);
  const Truth truth = read_truth(folder / "truth.json");
  Hog hog;
  Samples samples;
  cv::RNG rng(1);
  for (const TruthFrame& frame : truth.frames) {
    if (samples.trunks >= kMostTrunks) break;
    add_frame(samples, hog.descriptor, Panorama(images, folder / frame.file), frame, truth.height,
              rng);
  }
  hog.descriptor.setSVMDetector(train(samples));
  hog.threshold = best_threshold(hog, images, folder, truth);
  std::fprintf(stderr, "learnt from %d trunks and %d patches of background, threshold %.2f\n",
               samples.trunks, samples.labels.rows - samples.trunks, hog.threshold);
  return hog;
}

void measure_on(const Hog& hog, const fs::path& camera, const fs::path& folder) {
  ImageDetector images(camera, DetectorMode::paper);
  const Truth truth = read_truth(folder / "truth.json");
  const Detections detections = detect_in(hog, images, folder, truth);
  auto json = nlohmann::ordered_json::parse(to_json(measure(truth, detections, 0.5)));
  json["ap_of_all"] = measure(truth, detections, 0).ap;
  std::puts(json.dump().c_str());
}

}  // namespace
}  // namespace bole

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr,
                 "usage: hog_baseline TRAIN_CAMERA.toml TRAIN_DIR TEST_CAMERA.toml TEST_DIR\n");
    return 2;
  }
  try {
    bole::measure_on(bole::learn(argv[1], argv[2]), argv[3], argv[4]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "hog_baseline: %s\n", error.what());
    return 1;
  }
}
