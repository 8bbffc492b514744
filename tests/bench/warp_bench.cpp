#include <benchmark/benchmark.h>

#include <opencv2/imgproc.hpp>

#include "bench/bench_scene.h"
#include "warp/warper.h"

namespace bole::bench {
namespace {

// What everything is compared with: OpenCV's remap of a contiguous green plane, in one thread, with
// its fastest maps, the full panorama.
void opencv_remap_green(benchmark::State& state, ImageSize size) {
  const Scene& made = scene(size);
  const PanoramaGeometry& panorama = made.table.panorama();
  cv::Mat green(size.height, size.width, CV_8U,
                const_cast<std::byte*>(made.green.data()));  // read only
  cv::Mat x(panorama.rows, panorama.width, CV_32F), y(x.size(), CV_32F);
  for (int i = 0; i < panorama.rows; ++i) {
    for (int j = 0; j < panorama.width; ++j) {
      const Pixel source = made.table.source(i, j);
      x.at<float>(i, j) = static_cast<float>(source.column);
      y.at<float>(i, j) = static_cast<float>(source.row);
    }
  }
  cv::Mat map1, map2, out;
  cv::convertMaps(x, y, map1, map2, CV_16SC2);
  cv::setNumThreads(1);
  for (auto _ : state) {
    one_frame([&] { cv::remap(green, out, map1, map2, cv::INTER_LINEAR); });
    benchmark::DoNotOptimize(out.data);
  }
}

void warp(benchmark::State& state, ImageSize size, PixelFormat format) {
  const Scene& made = scene(size);
  const std::vector<std::byte> bytes = made.frame(format);
  const ImageView image = *view_packed(format, size, bytes);
  Warper warper(made.table);
  for (auto _ : state) {
    one_frame([&] { benchmark::DoNotOptimize(warper.warp(image).pixels); });
  }
}

const bool registered = [] {
  for (const ImageSize size : kSizes) {
    const auto add = [size](const std::string& subject, auto function, auto... arguments) {
      benchmark::RegisterBenchmark(name_of(subject, size).c_str(), function, size, arguments...)
          ->Unit(benchmark::kMicrosecond);
    };
    add("opencv_remap_green", opencv_remap_green);
    add("warp", warp, PixelFormat::yuyv);
    for (const PixelFormat format :
         {PixelFormat::grey, PixelFormat::rgb24, PixelFormat::rggb, PixelFormat::mjpeg}) {
      add("warp_" + std::string(name(format)), warp, format);
    }
  }
  return true;
}();

}  // namespace
}  // namespace bole::bench
