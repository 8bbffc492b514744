#include <benchmark/benchmark.h>

#include <opencv2/imgproc.hpp>

#include "bench/bench_scene.h"
#include "bench/paced.h"
#include "warp/warper.h"

namespace bole::bench {
namespace {

// What everything is compared with: OpenCV's remap of a contiguous green plane, in one thread, with
// its fastest maps, the full panorama.
class OpencvRemap {
 public:
  explicit OpencvRemap(const Scene& made) : size_(made.table.image_size()) {
    const PanoramaGeometry& panorama = made.table.panorama();
    cv::Mat x(panorama.rows, panorama.width, CV_32F), y(x.size(), CV_32F);
    for (int i = 0; i < panorama.rows; ++i) {
      for (int j = 0; j < panorama.width; ++j) {
        const Pixel source = made.table.source(i, j);
        x.at<float>(i, j) = static_cast<float>(source.column);
        y.at<float>(i, j) = static_cast<float>(source.row);
      }
    }
    cv::convertMaps(x, y, map1_, map2_, CV_16SC2);
    cv::setNumThreads(1);
  }

  void operator()(const std::vector<std::byte>& green) {
    const cv::Mat from(size_.height, size_.width, CV_8U,
                       const_cast<std::byte*>(green.data()));  // read only
    cv::remap(from, out_, map1_, map2_, cv::INTER_LINEAR);
    benchmark::DoNotOptimize(out_.data);
  }

 private:
  ImageSize size_;
  cv::Mat map1_, map2_, out_;
};

void opencv_remap_green(benchmark::State& state, ImageSize size) {
  const Scene& made = scene(size);
  OpencvRemap remap(made);
  for (auto _ : state) {
    one_frame([&] { remap(made.green); });
  }
}

void paced_opencv_remap_green(benchmark::State& state, ImageSize size) {
  const Scene& made = scene(size);
  const auto ring = ring_of(made.green);
  OpencvRemap remap(made);
  pace(state, [&](std::size_t k) { remap(ring[k]); });
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
    if (size.width == 1280) add("paced/opencv_remap_green", paced_opencv_remap_green);
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
