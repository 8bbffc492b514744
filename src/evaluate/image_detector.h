#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include <opencv2/core.hpp>

#include "detect/detector.h"
#include "warp/warper.h"

namespace bole {

/// A picture as 8-bit BGR, read as replay reads it. Throws std::runtime_error when it is missing,
/// damaged or no picture.
cv::Mat3b read_picture(const std::filesystem::path& file);

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

  /// The green panorama of `picture`, until the next call. Throws BadFrame when the size is not
  /// the calibration's.
  PanoramaView warp(const cv::Mat3b& picture);

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
