#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "capture/replay/frame_file.h"
#include "capture/replay/frame_names.h"
#include "commands/commands.h"
#include "commands/progress.h"
#include "evaluate/annotate.h"
#include "evaluate/camera_check.h"
#include "evaluate/image_detector.h"
#include "evaluate/mount_calibration.h"
#include "geometry/angles.h"
#include "warp/table_cache.h"

namespace bole {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string camera;
  std::string annotate;
  std::vector<std::string> images;  // of mount: folders too
  std::vector<std::string> trees;
  bool json = false;
};

void annotate(const Options& options, const Camera& camera, const WarpTable& table) {
  Warper warper(table);
  FrameReader reader(table.image_size());
  FrameSlot frame;
  std::size_t bad = 0;
  for (const fs::path image : options.images) {
    try {
      reader.read(image, frame);
      warper.warp(frame.view());  // refuses a frame that is damaged
    } catch (const std::runtime_error& error) {
      spdlog::error("{}: {}", image.string(), error.what());
      ++bad;
      continue;
    }
    write_frame_annotations(options.annotate, image.stem().string(), camera, table,
                            colours_of(frame), {});
  }
  if (bad > 0) {
    throw std::runtime_error("images that could not be drawn on: " + std::to_string(bad) + " of " +
                             std::to_string(options.images.size()));
  }
}

void check(const Options& options) {
  if (options.annotate.empty() != options.images.empty()) {
    throw ConfigError("--annotate", "", "goes with images",
                      "give --annotate FOLDER and IMAGE..., or neither");
  }
  const Camera camera = load_camera(options.camera);
  if (!options.annotate.empty()) prepare_annotations(options.annotate, options.images);
  const WarpTable table = load_or_build_warp_table(camera, default_cache_directory()).table;
  const CameraCheck found = check_camera(camera, table);
  std::puts((options.json ? to_json(found) : to_text(found)).c_str());
  if (!options.annotate.empty()) annotate(options, camera, table);
}

[[noreturn]] void refuse_tree(const std::string& text) {
  throw ConfigError(
      "--tree", "", "\"" + text + "\" is no measured tree",
      "write BEARING_DEG,RANGE_M, for instance -35,3.20: left of forward is positive, "
      "from -360 to 360 degrees and 0.1 to 100 m");
}

MeasuredTree parse_tree(const std::string& text) {
  double bearing = 0, range = 0;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, bearing);
  if (first.ec != std::errc{} || first.ptr == end || *first.ptr != ',') refuse_tree(text);
  const auto second = std::from_chars(first.ptr + 1, end, range);
  if (second.ec != std::errc{} || second.ptr != end) refuse_tree(text);
  // Written so that what is not a number is refused too.
  if (!(std::abs(bearing) <= 360 && range >= 0.1 && range <= 100)) refuse_tree(text);
  return {radians(bearing), range};
}

// What stands in one place twice would tell the height twice over.
std::vector<MeasuredTree> parse_trees(const std::vector<std::string>& texts) {
  std::vector<MeasuredTree> trees;
  for (const std::string& text : texts) {
    const MeasuredTree tree = parse_tree(text);
    for (const MeasuredTree& other : trees) {
      if (std::abs(wrap_angle(tree.bearing - other.bearing)) > kSameBearing) continue;
      throw ConfigError("--tree", "", "\"" + text + "\" stands beside another measured tree",
                        "give each tree once, and trees more than 3 degrees of bearing apart");
    }
    trees.push_back(tree);
  }
  return trees;
}

// Files and folders in their order, each file once: a frame that is given twice is no more evidence
// than once.
std::vector<fs::path> frames_of(const Options& options, const Camera& camera) {
  const fs::path mask = mask_file(camera);
  std::vector<fs::path> frames;
  std::set<fs::path> known;
  for (const fs::path path : options.images) {
    std::error_code error;
    const fs::path place = fs::canonical(path, error);
    if (error) {
      throw ConfigError(path, "", "cannot be opened: " + error.message(),
                        "give images, or folders of them");
    }
    if (!fs::is_directory(place, error)) {
      if (known.insert(place).second) frames.push_back(path);
      continue;
    }
    for (const fs::path& file : frames_in(path, mask)) {
      if (known.insert(fs::weakly_canonical(file, error)).second) frames.push_back(file);
    }
  }
  return frames;
}

/// A key of [mount] before and after, in camera.toml's unit.
struct Key {
  const char* name;
  double before;
  Measured after;
  int digits;

  // One standard deviation is passed by chance in one of three cameras that are as they should be.
  bool changed() const { return std::abs(after.value - before) >= 2 * after.sigma; }
};

std::vector<Key> keys_of(const CameraConfig& before, const MountCalibration& found) {
  const auto in_degrees = [](const Measured& angle) {
    return Measured{degrees(angle.value), degrees(angle.sigma)};
  };
  const Mount& mount = before.mount;
  std::vector<Key> keys = {{"roll_deg", degrees(mount.roll), in_degrees(found.roll), 2}};
  if (before.horizon_row && found.horizon_row) {
    keys.push_back({"horizon_row", *before.horizon_row, *found.horizon_row, 1});
  } else {
    keys.push_back({"pitch_deg", degrees(mount.pitch), in_degrees(found.pitch), 2});
  }
  if (found.height) keys.push_back({"height_m", mount.height, *found.height, 3});
  return keys;
}

void print_json(const std::vector<Key>& keys, const MountCalibration& found) {
  nlohmann::ordered_json left_out = nlohmann::ordered_json::array();
  for (const LeftOut& image : found.left_out) {
    left_out.push_back({{"file", image.file.string()}, {"error", image.error}});
  }
  nlohmann::ordered_json json = {{"frames", found.frames}, {"trunks", found.trunks}};
  for (const Key& key : keys) {
    json[key.name] = {{"old", key.before}, {"new", key.after.value}, {"sigma", key.after.sigma}};
  }
  const cv::Vec2d& difference = found.lean_against_feet.tilt;
  json["lean_against_feet_deg"] = {{"forward", degrees(difference[0])},
                                   {"left", degrees(difference[1])}};
  json["left_out"] = left_out;
  json["warnings"] = found.warnings;
  std::puts(json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
}

std::string counted(int number, const std::string& noun) {
  return std::to_string(number) + " " + noun + (number == 1 ? "" : "s");
}

void print_text(const std::vector<Key>& keys, const MountCalibration& found) {
  std::printf("%s, %s (one that was lost from sight may count again)\n",
              counted(found.frames, "frame").c_str(), counted(found.trunks, "trunk").c_str());
  for (const Key& key : keys) {
    std::printf("%-11s %.*f -> %.*f \u00b1 %.*f%s\n", key.name, key.digits, key.before, key.digits,
                key.after.value, key.digits, key.after.sigma,
                key.changed() ? "" : " (no change that these frames could tell)");
  }
  if (std::ranges::none_of(keys, &Key::changed)) {
    std::printf("\nleave [mount] of camera.toml as it is\n");
    return;
  }
  std::printf("\nfor [mount] of camera.toml:\n");
  for (const Key& key : keys) {
    if (key.changed()) std::printf("%s = %.*f\n", key.name, key.digits, key.after.value);
  }
}

void mount(const Options& options) {
  const std::vector<MeasuredTree> trees = parse_trees(options.trees);
  Camera camera = load_camera(options.camera);
  const CameraConfig before = camera.config;
  const MountCalibration found =
      calibrate_mount(camera, frames_of(options, camera), trees, show_progress);
  for (const LeftOut& bad : found.left_out) {
    spdlog::warn("left out: {}: {}", bad.file.string(), bad.error);
  }
  for (const std::string& warning : found.warnings) spdlog::warn("{}", warning);
  const std::vector<Key> keys = keys_of(before, found);
  if (options.json) {
    print_json(keys, found);
  } else {
    print_text(keys, found);
  }
}

}  // namespace

void add_calib(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("calib", "Checks a camera's files, and estimates how it is mounted");
  command->require_subcommand(1);
  const auto add_common = [&](CLI::App* sub) {
    sub->add_option("--camera", options->camera, "camera.toml")->type_name("FILE")->required();
    sub->add_flag("--json", options->json, "Print one line of JSON");
  };

  CLI::App* check_command = command->add_subcommand(
      "check", "Tells what a camera amounts to, and warns of what is likely a mistake");
  add_common(check_command);
  check_command
      ->add_option(
          "--annotate", options->annotate,
          "Folder for two pictures an image: panorama and raw image, with the horizon, the "
          "ground at whole metres and the robot's sides")
      ->type_name("FOLDER");
  check_command->add_option("IMAGE", options->images, "Images or raw frames to annotate")
      ->type_name("");
  check_command->callback([options] { check(*options); });

  CLI::App* mount_command = command->add_subcommand(
      "mount", "Estimates roll, pitch and height from frames of trunks; edits nothing");
  add_common(mount_command);
  mount_command
      ->add_option("--tree", options->trees,
                   "A tree measured by tape, from under the camera to the trunk's axis; the robot "
                   "stood still for all frames. Gives the height; may be given more than once")
      ->type_name("BEARING_DEG,RANGE_M")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  mount_command
      ->add_option("FRAMES", options->images,
                   "Images or raw frames of trunks, or folders of them, in order")
      ->type_name("")
      ->required();
  mount_command->callback([options] { mount(*options); });
}

}  // namespace bole
