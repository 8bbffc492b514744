#include "base/png_file.h"

#include <array>
#include <stdexcept>

#include <gtest/gtest.h>

namespace bole {
namespace {

std::vector<std::byte> encoded(PixelFormat format, ImageSize size, int stride,
                               std::span<const unsigned char> pixels) {
  return encode_png({format, size, {Plane{std::as_bytes(pixels), stride}, Plane{}}});
}

TEST(PngFile, IsTheSameForRedFirstAndBlueFirst) {
  constexpr std::array<unsigned char, 12> red_first{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  constexpr std::array<unsigned char, 16> blue_first{3, 2, 1, 6,  5,  4,  0, 0,
                                                     9, 8, 7, 12, 11, 10, 0, 0};
  const auto file = encoded(PixelFormat::rgb24, {2, 2}, 6, red_first);
  ASSERT_GT(file.size(), 60U);
  EXPECT_EQ(file[1], std::byte{'P'});
  EXPECT_TRUE(file == encoded(PixelFormat::bgr24, {2, 2}, 8, blue_first));
}

TEST(PngFile, OfNothingIsRefused) {
  EXPECT_THROW(encoded(PixelFormat::rgb24, {0, 0}, 0, {}), std::runtime_error);
}

}  // namespace
}  // namespace bole
