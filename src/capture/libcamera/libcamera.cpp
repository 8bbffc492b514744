#include "capture/libcamera/libcamera.h"

#include <cstdlib>
#include <utility>

#include "base/errors.h"
#include "capture/plugin.h"

namespace bole {
namespace {

const LibcameraPlugin& load() {
  // Read when libcamera is loaded; its chatter would drown our own lines.
  ::setenv("LIBCAMERA_LOG_LEVELS", "*:ERROR", 0);
  try {
    using Entry = const LibcameraPlugin& (*)();
    return reinterpret_cast<Entry>(load_plugin_symbol("bole_libcamera.so", "bole_libcamera"))();
  } catch (const std::runtime_error& error) {
    throw ConfigError("", "", error.what(),
                      "install the package bole-libcamera, or use v4l2:DEVICE");
  }
}

}  // namespace

const LibcameraPlugin& libcamera_plugin() {
  static const LibcameraPlugin& plugin = load();
  return plugin;
}

std::unique_ptr<FrameSource> make_libcamera_source(std::string id, const CameraSettings& settings,
                                                   const Clock& clock) {
  return libcamera_plugin().make_source(std::move(id), settings, clock);
}

}  // namespace bole
