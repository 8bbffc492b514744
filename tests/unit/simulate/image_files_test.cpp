#include "simulate/image_files.h"

#include <gtest/gtest.h>

namespace bole::simulate {
namespace {

// 4 x 2: red, green, blue, white; black, grey, grey, yellow.
Picture chart() {
  return {{4, 2}, {255, 0, 0, 0,   255, 0,   0,   0,   255, 255, 255, 255,
                   0,   0, 0, 128, 128, 128, 128, 128, 128, 255, 255, 0}};
}

std::vector<int> numbers(const std::vector<std::byte>& bytes) {
  std::vector<int> result;
  for (const std::byte b : bytes) result.push_back(std::to_integer<int>(b));
  return result;
}

TEST(ImageFiles, GreyIsLuma) {
  EXPECT_EQ(numbers(encode_raw(chart(), PixelFormat::grey)),
            (std::vector{76, 150, 29, 255, 0, 128, 128, 226}));
}

TEST(ImageFiles, BayerKeepsOneChannelAPixel) {
  EXPECT_EQ(numbers(encode_raw(chart(), PixelFormat::rggb)),
            (std::vector{255, 255, 0, 255, 0, 128, 128, 0}));
  EXPECT_EQ(numbers(encode_raw(chart(), PixelFormat::bggr)),
            (std::vector{0, 255, 255, 255, 0, 128, 128, 255}));
}

TEST(ImageFiles, YuvFormatsHoldTheSameLuma) {
  const auto grey = encode_raw(chart(), PixelFormat::grey);
  const auto yuyv = encode_raw(chart(), PixelFormat::yuyv);
  const auto uyvy = encode_raw(chart(), PixelFormat::uyvy);
  const auto nv12 = encode_raw(chart(), PixelFormat::nv12);
  ASSERT_EQ(nv12.size(), 12U);
  for (std::size_t i = 0; i < grey.size(); ++i) {
    EXPECT_EQ(yuyv.at(2 * i), grey[i]);
    EXPECT_EQ(uyvy.at(2 * i + 1), grey[i]);
    EXPECT_EQ(nv12[i], grey[i]);
  }
}

TEST(ImageFiles, SizesThatDoNotFitTheFormatAreRefused) {
  EXPECT_THROW(encode_raw({{1, 1}, {0, 0, 0}}, PixelFormat::yuyv), std::invalid_argument);
}

TEST(ImageFiles, JpegComesBackNearlyAsItWas) {
  const Picture grey{{16, 16}, std::vector<std::uint8_t>(16 * 16 * 3, 100)};
  for (const std::uint8_t value : through_jpeg(grey, 90).rgb) EXPECT_NEAR(value, 100, 2);
}

}  // namespace
}  // namespace bole::simulate
