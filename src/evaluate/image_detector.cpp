#include "evaluate/image_detector.h"

#include <algorithm>

#include <opencv2/imgproc.hpp>

#include "capture/replay/image_file.h"
#include "warp/table_cache.h"

namespace bole {
namespace {

constexpr float kLeastScore = 0.05F;

}  // namespace

cv::Mat3b read_picture(const std::filesystem::path& file) {
  FrameSlot slot;
  ImageReader().read(file, slot);
  const bool grey = slot.format == PixelFormat::grey;
  const cv::Mat stored(slot.size.height, slot.size.width, grey ? CV_8UC1 : CV_8UC3,
                       slot.bytes.data());
  cv::Mat3b picture;
  if (grey) {
    cv::cvtColor(stored, picture, cv::COLOR_GRAY2BGR);
  } else {
    stored.copyTo(picture);
  }
  return picture;
}

ImageView view_of(const cv::Mat3b& picture) {
  const std::span bytes(reinterpret_cast<const std::byte*>(picture.data),
                        picture.step * static_cast<std::size_t>(picture.rows));
  return {PixelFormat::bgr24,
          {picture.cols, picture.rows},
          {Plane{bytes, static_cast<int>(picture.step)}, Plane{}}};
}

ImageDetector::ImageDetector(const std::filesystem::path& camera_toml, DetectorMode mode)
    : camera_(load_camera(camera_toml)),
      table_(load_or_build_warp_table(camera_, default_cache_directory()).table),
      warper_(table_),
      detector_(make_detector(mode, {.panorama = table_.panorama(),
                                     .seen = table_.seen(),
                                     .height = camera_.config.mount.height,
                                     .search = camera_.config.search})) {}

PanoramaView ImageDetector::warp(const cv::Mat3b& picture) {
  return warper_.warp(view_of(picture));
}

std::span<const Tree> ImageDetector::detect(const PanoramaView& panorama,
                                            std::span<const ExpectedTrunk> expected) {
  const std::span<const Tree> trees = detector_->detect(panorama, expected);
  const auto end = std::find_if(trees.begin(), trees.end(),
                                [](const Tree& tree) { return tree.score < kLeastScore; });
  return trees.first(static_cast<std::size_t>(end - trees.begin()));
}

cv::Mat3b colour_panorama(const WarpTable& table, const cv::Mat3b& picture, double scale) {
  const PanoramaGeometry& panorama = table.panorama();
  cv::Mat2f source(panorama.rows, panorama.width);
  for (int i = 0; i < panorama.rows; ++i) {
    for (int j = 0; j < panorama.width; ++j) {
      const Pixel pixel = table.source(i, j);
      source(i, j) = {static_cast<float>(pixel.column), static_cast<float>(pixel.row)};
    }
  }
  cv::Mat3b colours;
  cv::remap(picture, colours, source, cv::noArray(), cv::INTER_LINEAR);
  cv::resize(colours, colours, {}, scale, scale, cv::INTER_CUBIC);
  return colours;
}

}  // namespace bole
