#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "base/toml_table.h"
#include "capture/camera_settings.h"
#include "detect/detector.h"
#include "publish/lcm_url.h"
#include "publish/zenoh_session.h"

namespace bole {

/// One bus that lists go to.
struct PublishTarget {
  enum class Bus { lcm, zenoh, jsonl };
  Bus bus;
  std::filesystem::path path;  ///< jsonl only; "-" for standard output
};

/// boled.toml: everything of a daemon but the camera's own file.
struct DaemonConfig {
  struct CameraPart {
    std::filesystem::path file = "/etc/bole/camera/camera.toml";
    std::string name;             ///< in messages and keys; by default camera.toml's folder
    std::filesystem::path table;  ///< empty: built by itself and kept in the cache
    std::filesystem::path cache_directory;  ///< empty: warp's default
  } camera;

  struct SourcePart {
    std::string uri;  ///< v4l2:DEVICE, libcamera:ID or replay:PATH
    std::string pace = "realtime";
    bool loop = false;
    bool restamp = false;
    double start = 0;                                      ///< seconds
    double end = std::numeric_limits<double>::infinity();  ///< seconds
    double rate = 10;                                      ///< Hz, of files without stamps
    std::filesystem::path faults;                          ///< script of a replay's faults
    CameraSettings camera;
  } source;

  struct DetectPart {
    DetectorMode mode = DetectorMode::bole;
    bool track = true;
  } detect;

  struct PublishPart {
    std::vector<PublishTarget> to;
    double min_score = 0.5;
    std::string robot = "robot";  ///< in Zenoh's keys
  } publish;

  LcmUrl lcm;
  ZenohConfig zenoh;

  struct ServicePart {
    int realtime_priority = 0;  ///< SCHED_FIFO of all threads, processing one below; 0: none
    bool lock_memory = false;
    std::filesystem::path trace;  ///< where the time of frames goes, for Chrome; empty: no trace
  } service;

  std::string file;  ///< where the settings stand, for messages
  std::string text;  ///< the file and the settings in one, as TOML
};

/// A key=value of the command line: the dotted key and TOML. What is not TOML and holds neither
/// quotes, brackets nor braces is taken as a string.
struct Setting {
  std::string key;
  std::string value;
};
/// Throws ConfigError when there is no "=" or no key.
Setting parse_setting(std::string_view text);
/// `text` as a string of TOML, for a setting that is never anything else.
std::string toml_text(std::string_view text);

/// Reads `file` (none: the defaults) and lays the settings over it, the later over the earlier.
/// Relative paths in the file become those in its own folder; in settings they are as they are.
/// Throws ConfigError for unknown keys and for whatever is not as it must be.
DaemonConfig load_daemon_config(const std::optional<std::filesystem::path>& file,
                                const std::vector<Setting>& settings);

/// CRC-32 of all that decides which lists a frame gives: the camera's files (`camera_digest`), its
/// name, [detect] and publish.min_score. Daemons with the same one can stand in for each other.
std::uint32_t config_crc(const DaemonConfig& config, std::uint32_t camera_digest);

}  // namespace bole
