#pragma once

#include <cstddef>
#include <opencv2/imgcodecs.hpp>
#include <span>
#include <vector>

#include "base/image.h"

namespace bole::test {

/// A JPEG of a colour ramp: red is the column, green the row, blue 40. With an `interval`, a
/// restart marker stands after every so many blocks.
inline std::vector<std::byte> ramp_jpeg(ImageSize size, int interval = 0) {
  cv::Mat ramp(size.height, size.width, CV_8UC3);
  for (int i = 0; i < size.height; ++i) {
    for (int j = 0; j < size.width; ++j) {
      ramp.at<cv::Vec3b>(i, j) = cv::Vec3b(40, static_cast<uchar>(i), static_cast<uchar>(j));
    }
  }
  std::vector<uchar> file;
  cv::imencode(".jpg", ramp, file, {cv::IMWRITE_JPEG_RST_INTERVAL, interval});
  const auto bytes = std::as_bytes(std::span(file));
  return {bytes.begin(), bytes.end()};
}

}  // namespace bole::test
