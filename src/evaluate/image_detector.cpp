#include "evaluate/image_detector.h"

#include <algorithm>
#include <optional>

#include <opencv2/imgproc.hpp>

#include "capture/replay/frame_file.h"
#include "capture/replay/jpeg.h"
#include "warp/table_cache.h"

namespace bole {
namespace {

constexpr float kLeastScore = 0.05F;

// OpenCV's code for the conversion to BGR; none where the pixels are BGR already.
std::optional<int> conversion_from(PixelFormat format) {
  switch (format) {
    case PixelFormat::grey:
      return cv::COLOR_GRAY2BGR;
    case PixelFormat::yuyv:
      return cv::COLOR_YUV2BGR_YUYV;
    case PixelFormat::uyvy:
      return cv::COLOR_YUV2BGR_UYVY;
    case PixelFormat::nv12:
      return cv::COLOR_YUV2BGR_NV12;
    // OpenCV's older names tell the second pixels of the second row.
    case PixelFormat::rggb:
      return cv::COLOR_BayerBG2BGR;
    case PixelFormat::grbg:
      return cv::COLOR_BayerGB2BGR;
    case PixelFormat::gbrg:
      return cv::COLOR_BayerGR2BGR;
    case PixelFormat::bggr:
      return cv::COLOR_BayerRG2BGR;
    case PixelFormat::rgb24:
      return cv::COLOR_RGB2BGR;
    default:
      return std::nullopt;
  }
}

// A tightly packed frame as OpenCV takes it: NV12 as one plane of one and a half times the height.
cv::Mat matrix_of(const FrameSlot& frame) {
  const int row_bytes = packed_row_bytes(frame.format, frame.size.width);
  const int rows = static_cast<int>(frame.bytes.size()) / row_bytes;
  return {rows, frame.size.width, CV_8UC(row_bytes / frame.size.width),
          const_cast<std::byte*>(frame.bytes.data())};  // which is only read
}

}  // namespace

cv::Mat3b colours_of(const FrameSlot& frame) {
  if (frame.format == PixelFormat::mjpeg) {
    FrameSlot decoded;
    decode_jpeg(frame.bytes, frame.size, decoded);
    return colours_of(decoded);
  }
  const cv::Mat stored = matrix_of(frame);
  const std::optional<int> conversion = conversion_from(frame.format);
  cv::Mat3b picture;
  if (conversion) {
    cv::cvtColor(stored, picture, *conversion);
  } else {
    stored.copyTo(picture);
  }
  return picture;
}

cv::Mat3b read_picture(const std::filesystem::path& file, ImageSize size) {
  FrameSlot slot;
  FrameReader(size).read(file, slot);
  return colours_of(slot);
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
