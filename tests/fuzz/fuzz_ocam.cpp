#include <string_view>

#include "base/errors.h"
#include "fuzz/fuzz_target.h"
#include "geometry/ocam.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const bole::OcamModel model =
        bole::parse_ocam({reinterpret_cast<const char*>(data), size}, "fuzz");
    const bole::Vec3 ray = model.ray_from_pixel({3, 5});
    model.pixel_from_ray(ray);
    model.pixel_from_ray_by_fit(ray);
  } catch (const bole::ConfigError&) {
    return 0;
  }
  return 0;
}
