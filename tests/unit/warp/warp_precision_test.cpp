#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "unit/warp/test_cameras.h"
#include "warp/warper.h"

namespace bole {
namespace {

double bilinear(const cv::Mat& image, const Pixel& at) {
  const int row = static_cast<int>(std::floor(at.row));
  const int column = static_cast<int>(std::floor(at.column));
  const double v = at.row - row, u = at.column - column;
  return (1 - v) * ((1 - u) * image.at<uchar>(row, column) + u * image.at<uchar>(row, column + 1)) +
         v * ((1 - u) * image.at<uchar>(row + 1, column) +
              u * image.at<uchar>(row + 1, column + 1));
}

struct Errors {
  double largest = 0, squares = 0;
  void add(double error) {
    largest = std::max(largest, std::abs(error));
    squares += error * error;
  }
};

TEST(WarpPrecision, IsNoWorseThanOpenCvRemapAgainstDoublePrecision) {
  const test::TemporaryFolder folder;
  const Camera camera = load_camera(write_small_camera(folder));
  const WarpTable table = build_warp_table(camera);
  const PanoramaGeometry& panorama = table.panorama();
  cv::Mat image(240, 320, CV_8U);
  std::minstd_rand random(11);
  std::generate_n(image.data, image.total(), [&] { return static_cast<uchar>(random() >> 8); });

  cv::Mat x(panorama.rows, panorama.width, CV_32F), y(x.size(), CV_32F);
  const auto place = [&](int i, int j) {
    return camera.model->pixel_from_ray(transposed(camera.robot_from_camera) * panorama.ray(i, j));
  };
  for (int i = 0; i < panorama.rows; ++i) {
    for (int j = 0; j < panorama.width; ++j) {
      x.at<float>(i, j) = static_cast<float>(place(i, j)->column);
      y.at<float>(i, j) = static_cast<float>(place(i, j)->row);
    }
  }
  cv::Mat map1, map2, remapped;
  cv::convertMaps(x, y, map1, map2, CV_16SC2);
  cv::remap(image, remapped, map1, map2, cv::INTER_LINEAR);

  Warper warper(table);
  const PanoramaView view = warper.warp(*view_packed(
      PixelFormat::grey, {320, 240}, std::as_bytes(std::span(image.data, image.total()))));
  Errors ours, theirs;
  for (int i = 0; i < panorama.rows; ++i) {
    for (int j = 0; j < panorama.width; ++j) {
      if (table.seen().pixels[static_cast<std::size_t>(i * panorama.width + j)] == 0) continue;
      const double truth = bilinear(image, *place(i, j));
      ours.add(view.row(i)[j] - truth);
      theirs.add(remapped.at<uchar>(i, j) - truth);
    }
  }
  EXPECT_LE(ours.largest, theirs.largest);
  EXPECT_LE(ours.squares, theirs.squares);
}

}  // namespace
}  // namespace bole
