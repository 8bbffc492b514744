#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "simulate/impairment.h"
#include "simulate/simulator.h"

namespace bole::simulate {

/// What a recording is to be.
struct RecordingOptions {
  int frames = 10;
  std::uint64_t seed = 1;
  std::string format = "jpg";  ///< png, jpg, or a raw pixel format's name (base/image.h)
  SimOptions world;
  std::optional<Impairment> impairment;
};

/// Renders a drive into `folder`, ready to be replayed: frame_000000.FORMAT and on, timestamps.csv,
/// truth.json, and the camera's files (camera.toml, calibration, mask) copied beside them.
/// The bytes do not depend on the number of threads.
/// `progress` is called after every frame with the number done, by one thread at a time. Throws
/// ConfigError when the folder cannot be written or the format is not known or does not fit the
/// camera's image.
void record(const std::filesystem::path& folder, const Camera& camera,
            const RecordingOptions& options, const std::function<void(int)>& progress);

/// The truth of several frames as JSON, in the form that tools/score.py reads.
std::string truth_json(const CameraConfig& config, const std::vector<FrameTruth>& frames);

}  // namespace bole::simulate
