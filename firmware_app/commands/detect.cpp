#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <utility>

#include "base/errors.h"
#include "commands/commands.h"
#include "evaluate/annotate.h"
#include "evaluate/detections.h"
#include "evaluate/image_detector.h"

namespace bole {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string camera;
  std::string mode = "bole";
  std::string annotate;
  std::vector<std::string> images;
};

void detect_in(ImageDetector& detector, const fs::path& image, const std::string& annotate) {
  const cv::Mat3b picture = read_picture(image);
  const std::span<const Tree> trees = detector.detect(picture);
  std::puts(detection_line(image.filename().string(), trees).c_str());
  if (annotate.empty()) return;
  write_annotations(annotate, image.stem().string(), detector.camera(), detector.table(), picture,
                    trees);
}

void detect(const Options& options) {
  ImageDetector detector(options.camera, *detector_mode_from_name(options.mode));
  std::vector<std::pair<std::string, std::string>> bad;  // images and what is wrong with them
  for (const fs::path image : options.images) {
    try {
      detect_in(detector, image, options.annotate);
    } catch (const std::runtime_error& error) {
      std::puts(error_line(image.filename().string(), error.what()).c_str());
      bad.emplace_back(image, error.what());
    }
    std::fflush(stdout);
  }
  if (bad.empty()) return;
  const std::string others =
      bad.size() == 1 ? "" : "so are " + std::to_string(bad.size() - 1) + " other images";
  throw ConfigError(bad.front().first, "", bad.front().second, others);
}

}  // namespace

void add_detect(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "detect", "Find trunks in images, each by itself; a line of JSON an image");
  command->add_option("--camera", options->camera, "camera.toml of the camera that took them")
      ->required();
  command->add_option("--mode", options->mode, "paper: the reference; bole: the product")
      ->check(CLI::IsMember({"bole", "paper"}))
      ->capture_default_str();
  command->add_option("--annotate", options->annotate,
                      "folder for three pictures an image: panorama, raw image, map");
  command->add_option("IMAGE", options->images, "image files")->required();
  command->callback([options] { detect(*options); });
}

}  // namespace bole
