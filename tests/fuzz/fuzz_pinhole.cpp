#include <string_view>

#include "base/errors.h"
#include "fuzz/fuzz_target.h"
#include "geometry/pinhole.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const bole::PinholeModel model =
        bole::parse_pinhole({reinterpret_cast<const char*>(data), size}, "fuzz");
    model.pixel_from_ray(model.ray_from_pixel({3, 5}));
  } catch (const bole::ConfigError&) {
    return 0;
  }
  return 0;
}
