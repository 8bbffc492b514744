// Trees of one raw frame, by the library alone: no daemon, no bus.
//
// usage: find_trees CAMERA.TOML FRAME      FRAME.grey, .yuyv, .nv12 ..., of the calibration's size
#include <cstdio>
#include <exception>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/files.h"
#include "detect/detector.h"
#include "warp/camera_files.h"
#include "warp/table_cache.h"
#include "warp/warper.h"

namespace {

constexpr std::size_t kLargestFrame = 1 << 28;  // bytes

bole::ImageView view_of_file(const std::filesystem::path& file, bole::ImageSize size,
                             std::span<const std::byte> bytes) {
  const std::string ending = file.extension().string();
  const auto format = bole::pixel_format_from_name(ending.empty() ? ending : ending.substr(1));
  if (!format) throw std::runtime_error(file.string() + ": its ending names no format of pixels");
  const auto image = bole::view_packed(*format, size, bytes);
  const bool varies = *format == bole::PixelFormat::mjpeg;
  const bool fits = varies || bytes.size() == bole::packed_frame_bytes(*format, size);
  if (!image || !fits)
    throw std::runtime_error(file.string() + ": is not of the calibration's size");
  return *image;
}

void find_trees(const std::filesystem::path& camera_toml, const std::filesystem::path& file) {
  // Once: the table is looked up for every pixel of every frame.
  const bole::Camera camera = bole::load_camera(camera_toml);
  const bole::WarpTable table =
      bole::load_or_build_warp_table(camera, bole::default_cache_directory()).table;
  bole::Warper warper(table);
  const auto detector =
      bole::make_detector(bole::DetectorMode::bole, {.panorama = table.panorama(),
                                                     .seen = table.seen(),
                                                     .height = camera.config.mount.height,
                                                     .search = camera.config.search});

  // For each frame.
  const std::vector<std::byte> bytes = bole::read_file(file, kLargestFrame);
  const bole::ImageView image = view_of_file(file, camera.model->image_size(), bytes);
  for (const bole::Tree& tree : detector->detect(warper.warp(image))) {
    if (tree.score < 0.5F) continue;
    std::printf("%+.3f rad, %.2f +- %.2f m, %.2f m thick, score %.2f\n", tree.bearing, tree.range,
                tree.range_sigma, tree.diameter, tree.score);
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) {
    std::fputs("usage: find_trees CAMERA.TOML FRAME\n", stderr);
    return 2;
  }
  try {
    find_trees(arguments[1], arguments[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "find_trees: %s\n", error.what());
    return 1;
  }
}
