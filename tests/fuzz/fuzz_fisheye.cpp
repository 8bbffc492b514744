#include <string_view>

#include "base/errors.h"
#include "fuzz/fuzz_target.h"
#include "geometry/fisheye.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const bole::FisheyeModel model =
        bole::parse_fisheye({reinterpret_cast<const char*>(data), size}, "fuzz", {1280, 960});
    model.pixel_from_ray(model.ray_from_pixel({3, 5}));
    model.pixel_from_ray({1, 2, -0.5});
  } catch (const bole::ConfigError&) {
    return 0;
  }
  return 0;
}
