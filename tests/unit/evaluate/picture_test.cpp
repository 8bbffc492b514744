#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "evaluate/image_detector.h"
#include "simulate/image_files.h"
#include "support/temporary_folder.h"

namespace bole {
namespace {

constexpr ImageSize kSize{16, 8};

std::string file_of(const simulate::Picture& picture, PixelFormat format) {
  const std::vector<std::byte> bytes = simulate::encode_raw(picture, format);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

class PictureOfRawFrame : public testing::TestWithParam<PixelFormat> {};

TEST_P(PictureOfRawFrame, HasItsColours) {
  simulate::Picture picture{kSize, {}};
  for (int i = 0; i < kSize.width * kSize.height; ++i) {
    picture.rgb.insert(picture.rgb.end(), {150, 120, 90});
  }
  const test::TemporaryFolder folder;
  const auto file =
      folder.write("frame." + std::string(name(GetParam())), file_of(picture, GetParam()));

  const cv::Mat3b read = read_picture(file, kSize);

  ASSERT_EQ(read.size(), cv::Size(kSize.width, kSize.height));
  const cv::Scalar grey(124.3, 124.3, 124.3), colour(90, 120, 150);
  const cv::Scalar wanted = GetParam() == PixelFormat::grey ? grey : colour;
  EXPECT_LT(cv::norm(cv::mean(read) - wanted), 12);  // YUV of the narrow range is a little steeper
}

INSTANTIATE_TEST_SUITE_P(EveryFormat, PictureOfRawFrame,
                         testing::Values(PixelFormat::grey, PixelFormat::yuyv, PixelFormat::uyvy,
                                         PixelFormat::nv12, PixelFormat::rggb, PixelFormat::grbg,
                                         PixelFormat::gbrg, PixelFormat::bggr, PixelFormat::rgb24,
                                         PixelFormat::bgr24, PixelFormat::mjpeg),
                         [](const auto& format) { return std::string(name(format.param)); });

}  // namespace
}  // namespace bole
