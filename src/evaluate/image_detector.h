#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include <opencv2/core.hpp>

#include "capture/frame_pool.h"
#include "detect/detector.h"
#include "warp/warper.h"

namespace bole {

/// A frame of any format as 8-bit BGR, for people to look at.
cv::Mat3b colours_of(const FrameSlot& frame);

/// A file's frame as 8-bit BGR, read as replay reads it. `size`: the calibration's, which raw
/// frames need; zero: an image of any size. Throws std::runtime_error when it is missing, damaged,
/// no frame or not of that size.
cv::Mat3b read_picture(const std::filesystem::path& file, ImageSize size = {});

/// The picture's own pixels, as an image.
ImageView view_of(const cv::Mat3b& picture);

/// From a picture to its trees, with one camera and one detector: each picture by itself.
class ImageDetector {
 public:
  /// Throws ConfigError when the camera's files or the searched trees do not fit. The table is
  /// taken from the cache that boled uses too.
  ImageDetector(const std::filesystem::path& camera_toml, DetectorMode mode);
  ImageDetector(const ImageDetector&) = delete;
  ImageDetector& operator=(const ImageDetector&) = delete;
  ~ImageDetector() = default;

  const Camera& camera() const { return camera_; }
  const WarpTable& table() const { return table_; }

  /// The green panorama of `image`, until the next call. Throws BadFrame when it is damaged or its
  /// size is not the calibration's.
  PanoramaView warp(const ImageView& image) { return warper_.warp(image); }

  /// The panorama's trees with a score of 0.05 or more, best first, until the next call.
  std::span<const Tree> detect(const PanoramaView& panorama,
                               std::span<const ExpectedTrunk> expected = {});

 private:
  Camera camera_;
  WarpTable table_;
  Warper warper_;
  std::unique_ptr<Detector> detector_;
};

/// The panorama in colour and `scale` times as large as the table's, for people to look at.
cv::Mat3b colour_panorama(const WarpTable& table, const cv::Mat3b& picture, double scale);

}  // namespace bole
