#pragma once

#include <png.h>

#include <cstdint>
#include <string>
#include <vector>

#include "support/temporary_folder.h"
#include "warp/camera_files.h"

namespace bole {

/// A small omnidirectional camera, 320 x 240, with a tilted mount and a panorama of 360 columns.
inline constexpr std::string_view kSmallOcam =
    "3 -45.6 0 8.1e-3\n2 75.5 62.5\n120.8 159.1\n0.9998 0.0002 -0.0002\n240 320\n";
inline constexpr std::string_view kSmallCameraToml = R"(
[camera]
model = "ocam"
calibration = "calib.txt"
MASK
[mount]
height_m = 1.05
left = "image right"
roll_deg = 2
pitch_deg = -3
yaw_deg = 5
[panorama]
columns = 360
elevation_top_deg = 27
range_min_m = 0.9
)";

inline void write_png(const std::filesystem::path& path, ImageSize size,
                      const std::vector<std::uint8_t>& pixels) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(size.width);
  image.height = static_cast<png_uint_32>(size.height);
  image.format = PNG_FORMAT_GRAY;
  png_image_write_to_file(&image, path.c_str(), 0, pixels.data(), 0, nullptr);
}

/// The small camera, written to `folder`; with a mask when one is given.
inline std::filesystem::path write_small_camera(const test::TemporaryFolder& folder,
                                                const std::vector<std::uint8_t>& mask = {}) {
  folder.write("calib.txt", kSmallOcam);
  std::string toml(kSmallCameraToml);
  toml.replace(toml.find("MASK"), 4, mask.empty() ? "" : "mask = \"mask.png\"");
  if (!mask.empty()) write_png(folder.path() / "mask.png", {320, 240}, mask);
  return folder.write("camera.toml", toml);
}

/// A camera that looks ahead, 160 x 120, 60 degrees wide.
inline std::filesystem::path write_pinhole(const test::TemporaryFolder& folder) {
  return folder.write("camera.toml", R"(
[camera]
model = "pinhole"
horizontal_fov_deg = 60
width = 160
height = 120
[mount]
height_m = 1.5
horizon_row = 50
[panorama]
columns = 720
elevation_top_deg = 20
range_min_m = 3
)");
}

}  // namespace bole
