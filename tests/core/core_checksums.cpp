// Prints checksums of what the core makes of one frame: the panorama in every pixel format by every
// kernel of this processor, and the trees. Run on two kinds of processor with the same folder, the
// lines must be equal.
//
// usage: core_checksums FOLDER      makes the table and the frames in FOLDER that are not there yet

#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include "base/checksum.h"
#include "base/files.h"
#include "bench/bench_scene.h"
#include "detect/detector.h"
#include "support/vector_targets.h"
#include "warp/warper.h"

namespace bole {
namespace {

constexpr ImageSize kSize{1280, 960};
constexpr PixelFormat kFormats[] = {PixelFormat::grey, PixelFormat::yuyv, PixelFormat::uyvy,
                                    PixelFormat::nv12, PixelFormat::rggb, PixelFormat::rgb24};

std::vector<std::byte> frame(const std::filesystem::path& folder, PixelFormat format) {
  const std::filesystem::path file = folder / ("frame." + std::string(name(format)));
  if (!std::filesystem::exists(file)) {
    write_file_atomically(file, bench::scene(kSize).frame(format));
  }
  return read_file(file, 1 << 24);
}

WarpTable table_of(const std::filesystem::path& folder, const Camera& camera) {
  const std::filesystem::path file = folder / "warp.table";
  if (!std::filesystem::exists(file)) build_warp_table(camera).store(file);
  return WarpTable::load(file, camera.digest);
}

void print(const std::string& what, const PanoramaView& view) {
  std::uint32_t crc = 0;
  for (int i = 0; i < view.geometry->rows; ++i) {
    crc = crc32(
        std::as_bytes(std::span(view.row(i), static_cast<std::size_t>(view.geometry->width))), crc);
  }
  std::printf("%s %08x\n", what.c_str(), crc);
}

// The last figures may differ where two processors' mathematical functions do.
void print(const std::string& mode, std::span<const Tree> trees) {
  for (const Tree& tree : trees) {
    std::printf("%s bearing %.4f range %.3f diameter %.3f score %.3f\n", mode.c_str(), tree.bearing,
                tree.range, tree.diameter, tree.score);
  }
}

void print_panoramas(const std::filesystem::path& folder, const WarpTable& table) {
  for (const PixelFormat format : kFormats) {
    const std::vector<std::byte> bytes = frame(folder, format);
    Warper warper(table);
    const ImageView image = *view_packed(format, kSize, bytes);
    for_each_vector_target([&](const char* target) {
      std::fprintf(stderr, "%s\n", target);
      print("panorama " + std::string(name(format)), warper.warp(image));
    });
  }
}

void print_trees(const std::filesystem::path& folder, const Camera& camera,
                 const WarpTable& table) {
  const std::vector<std::byte> bytes = frame(folder, PixelFormat::yuyv);
  Warper warper(table);
  const PanoramaView panorama = warper.warp(*view_packed(PixelFormat::yuyv, kSize, bytes));
  for (const auto& [mode, text] :
       {std::pair(DetectorMode::paper, "paper"), std::pair(DetectorMode::bole, "bole")}) {
    const auto detector = make_detector(
        mode, {table.panorama(), table.seen(), camera.config.mount.height, camera.config.search});
    print(text, detector->detect(panorama));
  }
}

void run(const std::filesystem::path& folder) {
  const Camera camera = load_camera(BOLE_SOURCE_DIR "/calib/example/camera.toml");
  const WarpTable table = table_of(folder, camera);
  print_panoramas(folder, table);
  print_trees(folder, camera, table);
}

}  // namespace
}  // namespace bole

int main(int argc, char** argv) {
  try {
    if (argc != 2) throw std::invalid_argument("usage: core_checksums FOLDER");
    bole::run(argv[1]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "core_checksums: %s\n", error.what());
    return 1;
  }
}
