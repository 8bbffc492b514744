#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "capture/replay/frame_file.h"
#include "commands/commands.h"
#include "evaluate/annotate.h"
#include "evaluate/detections.h"
#include "evaluate/image_detector.h"
#include "program.h"

namespace bole {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string camera;
  std::string mode = "bole";
  std::string annotate;
  std::vector<std::string> images;
};

void detect(const Options& options) {
  ImageDetector detector(options.camera, *detector_mode_from_name(options.mode));
  if (!options.annotate.empty()) prepare_annotations(options.annotate, options.images);
  std::size_t bad = 0;
  std::string first_bad;  // the image and what is wrong with it
  FrameReader reader(detector.table().image_size());
  FrameSlot frame;
  for (const fs::path image : options.images) {
    std::span<const Tree> trees;
    try {
      reader.read(image, frame);
      trees = detector.detect(detector.warp(frame.view()));
    } catch (const std::runtime_error& error) {
      std::puts(error_line(image.filename().string(), error.what()).c_str());
      if (bad++ == 0) first_bad = image.string() + ": " + error.what();
      continue;
    }
    std::puts(detection_line(image.filename().string(), trees).c_str());
    flush_output();
    if (!options.annotate.empty()) {
      write_annotations(options.annotate, image.stem().string(), detector.camera(),
                        detector.table(), colours_of(frame), trees);
    }
  }
  if (bad > 1) first_bad += "; bad images in all: " + std::to_string(bad);
  if (bad > 0) throw std::runtime_error(first_bad);
}

}  // namespace

void add_detect(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "detect", "Finds trunks in images, each by itself; prints a line of JSON an image");
  command->add_option("--camera", options->camera, "camera.toml of the camera that took them")
      ->type_name("FILE")
      ->required();
  command->add_option("--mode", options->mode, "The detector: bole, or paper for the reference")
      ->check(CLI::IsMember({"bole", "paper"}))
      ->capture_default_str();
  command
      ->add_option("--annotate", options->annotate,
                   "Folder for three pictures an image: panorama, raw image, map")
      ->type_name("FOLDER");
  command->add_option("IMAGE", options->images, "Images or raw frames")->type_name("")->required();
  command->callback([options] { detect(*options); });
}

}  // namespace bole
