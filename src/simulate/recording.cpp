#include "simulate/recording.h"

#include <algorithm>
#include <cstdio>
#include <future>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>
#include <thread>

#include "base/errors.h"
#include "base/files.h"
#include "geometry/angles.h"
#include "simulate/image_files.h"

namespace bole::simulate {
namespace {

std::string side_name(ImageSide side) {
  switch (side) {
    case ImageSide::up:
      return "image up";
    case ImageSide::down:
      return "image down";
    case ImageSide::left:
      return "image left";
    case ImageSide::right:
      break;
  }
  return "image right";
}

nlohmann::ordered_json tree_json(const TreeTruth& t) {
  return {{"id", t.id},
          {"x", t.x},
          {"y", t.y},
          {"z", t.z},
          {"diameter", t.diameter},
          {"range", t.range},
          {"bearing", t.bearing},
          {"visible", t.visible},
          {"foot_visible", t.foot_visible},
          {"base_elevation", t.base_elevation},
          {"angular_width", t.angular_width},
          {"lean_x", t.lean_x},
          {"lean_y", t.lean_y},
          {"bright", t.bright}};
}

void write_text(const std::filesystem::path& path, const std::string& text) {
  write_file_atomically(path, std::as_bytes(std::span(text)));
}

std::string frame_name(int k, const std::string& format) {
  char name[64];
  (void)std::snprintf(name, sizeof name, "frame_%06d.%s", k, format.c_str());
  return name;
}

// Encodes pictures in the one format of a recording.
class Encoder {
 public:
  Encoder(const std::string& format, ImageSize size) : format_(format) {
    if (format == "png" || format == "jpg") return;
    raw_ = pixel_format_from_name(format);
    if (!raw_) {
      throw ConfigError("--format", "", "\"" + format + "\" is not known",
                        "must be png, jpg, or a raw pixel format such as yuyv, nv12, grey, rggb");
    }
    if (*raw_ == PixelFormat::mjpeg) return;
    const std::vector<std::byte> bytes(packed_frame_bytes(*raw_, size));
    if (!view_packed(*raw_, size, bytes)) {
      throw ConfigError("--format", "", format + " needs an even image size",
                        "take png, jpg or grey");
    }
  }

  std::vector<std::byte> encode(const Picture& picture) const {
    if (raw_) return encode_raw(picture, *raw_);
    return format_ == "png" ? encode_png(picture) : encode_jpeg(picture, 92);
  }

 private:
  std::string format_;
  std::optional<PixelFormat> raw_;
};

void copy_camera(const std::filesystem::path& folder, const Camera& camera) {
  constexpr std::size_t kLargest = 1U << 26;
  const auto from = camera.file.parent_path();
  write_text(folder / "camera.toml", camera.config_text);
  for (const std::string& name : {camera.config.calibration, camera.config.mask}) {
    const std::filesystem::path path(name);
    if (path.empty() || path.is_absolute()) continue;  // which is found from anywhere
    if (*path.lexically_normal().begin() == "..") {
      throw ConfigError(camera.file, "", name + " lies outside of its folder, which is copied",
                        "put it beside camera.toml");
    }
    write_file_atomically(folder / path, read_file(from / path, kLargest));
  }
}

// A replay would take frames of an earlier recording for frames of this one.
void refuse_other_frames(const std::filesystem::path& folder, const RecordingOptions& options) {
  std::set<std::string> ours;
  for (int k = 0; k < options.frames; ++k) ours.insert(frame_name(k, options.format));
  std::error_code not_there;
  for (const auto& entry : std::filesystem::directory_iterator(folder, not_there)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("frame_") && !ours.contains(name)) {
      throw ConfigError(folder, "", "holds " + name + " of another recording",
                        "remove its frames, or name another folder");
    }
  }
}

}  // namespace

std::string truth_json(const CameraConfig& config, const std::vector<FrameTruth>& frames) {
  const Mount& mount = config.mount;
  nlohmann::ordered_json json = {
      {"metric", true},
      {"mount", {{"forward", side_name(mount.forward)}, {"left", side_name(mount.left)}}},
      {"height_m", mount.height},
      {"roll_deg", degrees(mount.roll)},
      {"pitch_deg", degrees(mount.pitch)},
      {"yaw_deg", degrees(mount.yaw)},
      {"frames", nlohmann::ordered_json::array()}};
  for (const FrameTruth& frame : frames) {
    nlohmann::ordered_json trees = nlohmann::ordered_json::array();
    for (const TreeTruth& tree : frame.trees) trees.push_back(tree_json(tree));
    const Pose& pose = frame.pose;
    json["frames"].push_back({{"file", frame.file},
                              {"utime", frame.utime},
                              {"world", frame.world},
                              {"pose",
                               {{"x", pose.x},
                                {"y", pose.y},
                                {"heading", pose.heading},
                                {"roll", pose.roll},
                                {"pitch", pose.pitch}}},
                              {"trees", trees}});
  }
  return json.dump(1) + "\n";
}

void record(const std::filesystem::path& folder, const Camera& camera,
            const RecordingOptions& options, const std::function<void(int)>& progress) {
  const Encoder encoder(options.format, camera.model->image_size());
  refuse_other_frames(folder, options);
  copy_camera(folder, camera);
  std::vector<FrameTruth> truths(static_cast<std::size_t>(options.frames));
  std::mutex mutex;
  int done = 0;
  const auto render = [&](int first, int step) {
    Simulator simulator(options.world, options.seed, camera, options.frames);
    std::optional<Impairer> impairer;
    if (options.impairment) impairer.emplace(*options.impairment, options.seed);
    for (int k = first; k < options.frames; k += step) {
      SimFrame frame = simulator.frame(k);
      frame.truth.file = frame_name(k, options.format);
      if (impairer) frame.picture = impairer->apply(frame.picture);
      write_file_atomically(folder / frame.truth.file, encoder.encode(frame.picture));
      truths[k] = std::move(frame.truth);
      const std::lock_guard lock(mutex);
      progress(++done);
    }
  };
  // What befalls a lens goes on from frame to frame: one thread then.
  const int threads =
      options.impairment
          ? 1
          : static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 8U));
  std::vector<std::future<void>> workers;
  workers.reserve(static_cast<std::size_t>(threads));
  for (int i = 0; i < std::min(threads, options.frames); ++i) {
    workers.push_back(std::async(std::launch::async, render, i, threads));
  }
  for (auto& worker : workers) worker.get();

  std::string stamps;
  for (const FrameTruth& truth : truths)
    stamps += truth.file + "," + std::to_string(truth.utime) + "\n";
  write_text(folder / "timestamps.csv", stamps);
  write_text(folder / "truth.json", truth_json(camera.config, truths));
}

}  // namespace bole::simulate
