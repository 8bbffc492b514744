#include <string_view>

#include "base/errors.h"
#include "fuzz/fuzz_target.h"
#include "geometry/camera_config.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    bole::panorama_of(
        bole::parse_camera_config({reinterpret_cast<const char*>(data), size}, "fuzz"));
  } catch (const bole::ConfigError&) {
    return 0;
  }
  return 0;
}
