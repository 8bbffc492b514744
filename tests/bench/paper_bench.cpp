#include <benchmark/benchmark.h>

#include <opencv2/imgproc.hpp>

#include "bench/bench_scene.h"
#include "detect/paper/paper_templates.h"
#include "warp/warper.h"

namespace bole::bench {
namespace {

// A panorama as OpenCV is given it: with the columns that lie within a template's reach behind the
// seam on both sides, so that its borders need not wrap.
struct OpenCvScene {
  cv::Mat1f panorama;
  int margin = 0;
  std::vector<PaperTemplate> templates;
};

OpenCvScene opencv_scene(ImageSize size) {
  const Scene& made = scene(size);
  const std::vector<std::byte> bytes = made.frame(PixelFormat::yuyv);
  Warper warper(made.table);
  const PanoramaView view = warper.warp(*view_packed(PixelFormat::yuyv, size, bytes));
  OpenCvScene result;
  result.templates =
      paper_templates(*view.geometry, made.camera.config.mount.height, made.camera.config.search);
  for (const PaperTemplate& t : result.templates) {
    result.margin = std::max(result.margin, t.reach());
  }
  const cv::Mat1b green(view.geometry->rows, view.geometry->width,
                        const_cast<std::uint8_t*>(view.pixels), view.stride);
  cv::Mat1b wide;
  cv::copyMakeBorder(green, wide, 0, 0, result.margin, result.margin, cv::BORDER_WRAP);
  wide.convertTo(result.panorama, CV_32F);
  return result;
}

cv::Mat1f profile_of(const PaperTemplate& t) {
  cv::Mat1f profile(1, 2 * t.reach() + 1);
  for (int x = -t.reach(); x <= t.reach(); ++x) profile(t.reach() + x) = t.bar[std::abs(x)];
  return profile;
}

// S of every template from filtered panoramas, as the paper computes it.
template <class Filter>
void paper_by_opencv(benchmark::State& state, ImageSize size, const Filter& filter) {
  const OpenCvScene made = opencv_scene(size);
  cv::setNumThreads(1);
  cv::Mat filtered, sum;
  for (auto _ : state) {
    one_frame([&] {
      for (const PaperTemplate& t : made.templates) {
        filter(made.panorama, filtered, profile_of(t));
        cv::reduce(filtered.rowRange(0, t.foot_row + 1), sum, 0, cv::REDUCE_SUM);
        sum /= t.width_px * t.width_px * (t.foot_row + 1) * t.foot_distance;
        benchmark::DoNotOptimize(sum.data);
      }
    });
  }
}

void paper_literal_opencv(benchmark::State& state, ImageSize size) {
  paper_by_opencv(state, size, [](const cv::Mat& in, cv::Mat& out, const cv::Mat1f& profile) {
    const cv::Mat bar = cv::repeat(profile, profile.cols, 1);
    cv::filter2D(in, out, CV_32F, bar, {-1, -1}, 0, cv::BORDER_REPLICATE);
  });
}

void paper_separable_opencv(benchmark::State& state, ImageSize size) {
  paper_by_opencv(state, size, [](const cv::Mat& in, cv::Mat& out, const cv::Mat1f& profile) {
    const cv::Mat1f ones(profile.cols, 1, 1.0F);
    cv::sepFilter2D(in, out, CV_32F, profile, ones, {-1, -1}, 0, cv::BORDER_REPLICATE);
  });
}

const bool registered = [] {
  for (const ImageSize size : kSizes) {
    const auto add = [size](const std::string& subject, auto function) {
      benchmark::RegisterBenchmark(name_of(subject, size).c_str(), function, size)
          ->Unit(benchmark::kMicrosecond)
          ->Iterations(1);
    };
    add("paper_literal_opencv", paper_literal_opencv);
    add("paper_separable_opencv", paper_separable_opencv);
  }
  return true;
}();

}  // namespace
}  // namespace bole::bench
