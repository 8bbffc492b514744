#include "capture/replay/codecs.h"

#include <cstdlib>

#include "base/errors.h"
#include "capture/plugin.h"
#include "capture/replay/image_file.h"

namespace bole {
namespace {

const ReplayCodecs& load() {
  // OpenCV reads its limit when it is loaded, and takes it only from here.
  const std::string limit = std::to_string(kMaxImagePixels);
  ::setenv("OPENCV_IO_MAX_IMAGE_PIXELS", limit.c_str(), 1);
  constexpr auto* kFile = "bole_replay_codecs.so";
  try {
    using Entry = const ReplayCodecs& (*)();
    return reinterpret_cast<Entry>(load_plugin_symbol(kFile, "bole_replay_codecs"))();
  } catch (const std::runtime_error& error) {
    throw ConfigError("", "", error.what(),
                      "install the package bole-replay-codecs, or replay JPEG, PNG or raw frames");
  }
}

}  // namespace

const ReplayCodecs& replay_codecs() {
  static const ReplayCodecs& codecs = load();
  return codecs;
}

}  // namespace bole
