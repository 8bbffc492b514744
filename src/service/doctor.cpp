#include "service/doctor.h"

#include <pwd.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <functional>
#include <system_error>

#include "base/errors.h"
#include "base/files.h"
#include "capture/frame_source.h"
#include "capture/libcamera/libcamera.h"
#include "capture/v4l2/device.h"
#include "publish/lcm_url.h"
#include "service/make_source.h"
#include "warp/table_cache.h"

namespace bole {
namespace {

std::string user_name() {
  const passwd* const user = ::getpwuid(::geteuid());
  return user != nullptr ? user->pw_name : std::to_string(::geteuid());
}

// Said of what another user may find otherwise. `service`: what holds for the service's own user,
// who is us where systemd has given us a cache.
std::string as_user(const std::string& service) {
  const bool we_are_it = std::getenv("CACHE_DIRECTORY") != nullptr;
  return " (as user " + user_name() + (we_are_it ? "" : "; the service " + service) + ")";
}

// `check` returns what is good to know and throws what is wrong; `remark` stands behind either.
Finding look(const std::string& name, const std::string& remark,
             const std::function<std::string()>& check) {
  try {
    return {name, true, check() + remark};
  } catch (const std::exception& error) {
    return {name, false, error.what() + remark};
  }
}

std::string table_detail(const DaemonConfig::CameraPart& part, const Camera& camera) {
  if (!part.table.empty()) {
    WarpTable::load(part.table, camera.digest);
    return part.table.string() + " fits the camera";
  }
  build_warp_table(camera);  // as boled does where it keeps none; refuses what cannot be built
  const auto folder =
      part.cache_directory.empty() ? default_cache_directory() : part.cache_directory;
  try {
    if (folder.empty()) throw ConfigError("", "", "no cache directory is set", "");
    check_replaceable(folder / "warp.table");
  } catch (const ConfigError& error) {
    throw std::runtime_error(std::string(error.what()) +
                             "; it is not kept, each start builds it anew; set "
                             "camera.cache_directory");
  }
  return "kept in " + folder.string();
}

std::string device_detail(const std::string& name) {
  const std::filesystem::path node = find_v4l2_device(name);
  if (::access(node.c_str(), R_OK | W_OK) != 0) {
    throw std::runtime_error(node.string() +
                             " may not be opened; add the user to its group: adduser " +
                             user_name() + " video");
  }
  const V4l2Device device(node);
  device.capture_type();
  const v4l2_capability capability = device.capability();
  return node.string() + ", " + reinterpret_cast<const char*>(capability.card);
}

std::string libcamera_detail(const std::string& uri) {
  for (const CameraInfo& camera : libcamera_plugin().list()) {
    if (camera.source == uri) return uri + ", " + camera.model;
  }
  throw std::runtime_error(uri + " " + kNotThere + kPlugItIn);
}

std::string source_detail(const DaemonConfig& config, const Camera& camera) {
  const SourceSetup setup = make_source(config, camera);
  if (setup.kind == ListSource::replay) return setup.source->description();
  if (setup.kind == ListSource::libcamera) return libcamera_detail(config.source.uri);
  const std::string name = config.source.uri.substr(config.source.uri.find(':') + 1);
  try {
    return device_detail(name);
  } catch (const CaptureError& error) {
    throw std::runtime_error(name + " " + error.what() + kPlugItIn);
  }
}

std::string lcm_detail(const LcmUrl& url) {
  const std::string problem = missing_route(url);
  if (!problem.empty()) throw std::runtime_error(problem);
  return url.text() + (url.ttl == 0 ? ", stays on this machine; ttl=1 reaches the network" : "");
}

std::string zenoh_detail(const ZenohConfig& config) {
#ifdef BOLE_ZENOH
  check_zenoh(config);
  if (config.listen.empty() && config.connect.empty() && config.config_file.empty()) {
    return std::string("listens on ") + kDefaultZenohEndpoint + ", this machine only";
  }
  return "its settings fit together";
#else
  static_cast<void>(config);
  throw std::runtime_error("is not in this build; install cargo and build again");
#endif
}

std::string jsonl_detail(const std::filesystem::path& file) {
  if (file == "-") return "standard output";
  std::error_code error;
  const bool there = std::filesystem::exists(file, error);
  if (std::filesystem::is_directory(file, error)) {
    throw std::runtime_error(file.string() + " is a directory; name a file in it");
  }
  const auto folder = file.has_parent_path() ? file.parent_path() : ".";
  if (::access(there ? file.c_str() : folder.c_str(), W_OK) != 0) {
    throw std::runtime_error(file.string() + " cannot be written: " + error_text(errno));
  }
  return file.string();
}

std::string target_detail(const PublishTarget& target, const DaemonConfig& config) {
  switch (target.bus) {
    case PublishTarget::Bus::lcm:
      return lcm_detail(config.lcm);
    case PublishTarget::Bus::zenoh:
      return zenoh_detail(config.zenoh);
    case PublishTarget::Bus::jsonl:
      break;
  }
  return jsonl_detail(target.path);
}

std::string name(PublishTarget::Bus bus) {
  return bus == PublishTarget::Bus::lcm     ? "lcm"
         : bus == PublishTarget::Bus::zenoh ? "zenoh"
                                            : "jsonl";
}

// What as_user() says of each check; empty where the user makes no difference.

std::string table_remark(const DaemonConfig::CameraPart& part) {
  return as_user(part.table.empty() && part.cache_directory.empty()
                     ? "keeps its own in /var/cache/bole"
                     : "has a user of its own");
}

std::string source_remark(const std::string& uri) {
  return as_user(uri.starts_with("replay:") ? "has a user of its own"
                                            : "has a user of its own, in the group video");
}

std::string target_remark(const PublishTarget& target, const ZenohConfig& zenoh) {
  using Bus = PublishTarget::Bus;
  const bool files =
      !zenoh.config_file.empty() || !zenoh.tls.ca.empty() || !zenoh.tls.certificate.empty();
  if (target.bus == Bus::zenoh && files) return as_user("has a user of its own");
  if (target.bus == Bus::jsonl && target.path != "-")
    return as_user("writes in /var/lib/bole only");
  return "";
}

}  // namespace

std::vector<Finding> examine(const DaemonConfig& config) {
  std::vector<Finding> findings;
  std::optional<Camera> camera;
  findings.push_back(look("camera files", as_user("has a user of its own"), [&] {
    camera = load_camera(config.camera.file);
    return config.camera.file.string();
  }));
  if (camera) {
    findings.push_back(look("warp table", table_remark(config.camera),
                            [&] { return table_detail(config.camera, *camera); }));
    findings.push_back(look("source", source_remark(config.source.uri),
                            [&] { return source_detail(config, *camera); }));
  }
  for (const PublishTarget& target : config.publish.to) {
    findings.push_back(look(name(target.bus), target_remark(target, config.zenoh),
                            [&] { return target_detail(target, config); }));
  }
  const std::filesystem::path& trace = config.service.trace;
  if (!trace.empty()) {
    findings.push_back(look("trace", as_user("writes in /var/lib/bole only"), [&] {
      check_replaceable(trace);
      return trace.string();
    }));
  }
  return findings;
}

}  // namespace bole
