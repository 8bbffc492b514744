#include <benchmark/benchmark.h>

#include <functional>
#include <map>
#include <string>

#include "bench/bench_scene.h"
#include "detect/detector.h"
#include "warp/warper.h"

namespace bole::bench {
namespace {

// One thing changed about the usual scene.
struct Variation {
  std::string name;  // "<what>/<value>"
  ImageSize size{1280, 960};
  std::function<void(CameraConfig&)> change;
};

std::vector<Variation> variations() {
  std::vector<Variation> all;
  for (const int columns : {720, 1080, 1440, 2160, 2880})
    all.push_back({.name = "columns/" + std::to_string(columns),
                   .change = [columns](CameraConfig& c) { c.columns = columns; }});
  for (const int range : {4, 8, 16, 40})
    all.push_back({.name = "farthest_range_m/" + std::to_string(range),
                   .change = [range](CameraConfig& c) { c.search.range.high = range; }});
  for (const int ratio : {2, 4, 8, 16})
    all.push_back({.name = "widest_to_narrowest_diameter/" + std::to_string(ratio),
                   .change = [ratio](CameraConfig& c) {
                     c.search.diameter = {0.8 / ratio, 0.8};
                   }});
  for (const ImageSize size : {ImageSize{640, 480}, {1280, 960}, {1920, 1440}, {2592, 1944}})
    all.push_back(
        {.name = "image_columns/" + std::to_string(size.width), .size = size, .change = {}});
  return all;
}

const Scene& scene_of(const Variation& variation) {
  static std::map<std::string, Scene> scenes;
  const auto found = scenes.find(variation.name);
  return found != scenes.end()
             ? found->second
             : scenes.emplace(variation.name, make_scene(variation.size, variation.change))
                   .first->second;
}

void warp(benchmark::State& state, const Variation& variation) {
  const Scene& made = scene_of(variation);
  const std::vector<std::byte> bytes = made.frame(PixelFormat::yuyv);
  const ImageView image = *view_packed(PixelFormat::yuyv, variation.size, bytes);
  Warper warper(made.table);
  for (auto _ : state) benchmark::DoNotOptimize(warper.warp(image).pixels);
}

void detect(benchmark::State& state, const Variation& variation, DetectorMode mode) {
  const Scene& made = scene_of(variation);
  const std::vector<std::byte> bytes = made.frame(PixelFormat::yuyv);
  Warper warper(made.table);
  const PanoramaView panorama = warper.warp(*view_packed(PixelFormat::yuyv, variation.size, bytes));
  const std::unique_ptr<Detector> detector =
      make_detector(mode, {.panorama = made.table.panorama(),
                           .seen = made.table.seen(),
                           .height = made.camera.config.mount.height,
                           .search = made.camera.config.search});
  for (auto _ : state) benchmark::DoNotOptimize(detector->detect(panorama).data());
}

const bool registered = [] {
  for (const Variation& variation : variations()) {
    const auto add = [&](const char* stage, auto function, auto... arguments) {
      benchmark::RegisterBenchmark((variation.name + "/" + stage).c_str(), function, variation,
                                   arguments...)
          ->Unit(benchmark::kMicrosecond);
    };
    add("warp", warp);
    add("paper", detect, DetectorMode::paper);
    add("bole", detect, DetectorMode::bole);
  }
  return true;
}();

}  // namespace
}  // namespace bole::bench
