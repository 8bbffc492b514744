#include <benchmark/benchmark.h>

#include "bench/bench_scene.h"
#include "bench/paced.h"
#include "detect/detector.h"
#include "warp/warper.h"

namespace bole::bench {
namespace {

DetectorSetup setup_of(const Scene& made) {
  return {.panorama = made.table.panorama(),
          .seen = made.table.seen(),
          .height = made.camera.config.mount.height,
          .search = made.camera.config.search};
}

// The detector alone, on a panorama that is there.
void detect(benchmark::State& state, ImageSize size, DetectorMode mode) {
  const Scene& made = scene(size);
  const std::vector<std::byte> bytes = made.frame(PixelFormat::yuyv);
  Warper warper(made.table);
  const PanoramaView panorama = warper.warp(*view_packed(PixelFormat::yuyv, size, bytes));
  const std::unique_ptr<Detector> detector = make_detector(mode, setup_of(made));
  for (auto _ : state) {
    one_frame([&] { benchmark::DoNotOptimize(detector->detect(panorama).data()); });
  }
}

void frame_to_trees(benchmark::State& state, ImageSize size, DetectorMode mode,
                    PixelFormat format) {
  const Scene& made = scene(size);
  const std::vector<std::byte> bytes = made.frame(format);
  const ImageView image = *view_packed(format, size, bytes);
  Warper warper(made.table);
  const std::unique_ptr<Detector> detector = make_detector(mode, setup_of(made));
  for (auto _ : state) {
    one_frame([&] { benchmark::DoNotOptimize(detector->detect(warper.warp(image)).data()); });
  }
}

void paced_frame_to_trees(benchmark::State& state, ImageSize size, DetectorMode mode) {
  const Scene& made = scene(size);
  const auto ring = ring_of(made.frame(PixelFormat::yuyv));
  Warper warper(made.table);
  const std::unique_ptr<Detector> detector = make_detector(mode, setup_of(made));
  pace(state, [&](std::size_t k) {
    const ImageView image = *view_packed(PixelFormat::yuyv, size, ring[k]);
    benchmark::DoNotOptimize(detector->detect(warper.warp(image)).data());
  });
}

const bool registered = [] {
  constexpr std::pair<DetectorMode, const char*> kModes[] = {{DetectorMode::paper, "paper"},
                                                             {DetectorMode::bole, "bole"}};
  for (const ImageSize size : kSizes) {
    const auto add = [size](const std::string& subject, auto function, auto... arguments) {
      benchmark::RegisterBenchmark(name_of(subject, size).c_str(), function, size, arguments...)
          ->Unit(benchmark::kMicrosecond);
    };
    for (const auto& [mode, mode_name] : kModes) {
      add(mode_name, detect, mode);
      if (size.width == 1280) {
        add("paced/frame_to_trees/" + std::string(mode_name) + "/yuyv", paced_frame_to_trees, mode);
      }
      for (const PixelFormat format : {PixelFormat::yuyv, PixelFormat::grey, PixelFormat::mjpeg}) {
        add("frame_to_trees/" + std::string(mode_name) + "/" + std::string(name(format)),
            frame_to_trees, mode, format);
      }
    }
  }
  return true;
}();

}  // namespace
}  // namespace bole::bench
