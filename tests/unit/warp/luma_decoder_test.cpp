#include "warp/luma_decoder.h"

#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <algorithm>
#include <memory>

#include "warp/bad_frame.h"

namespace bole {
namespace {

constexpr ImageSize kSize{160, 120};

// A colour ramp whose luma is known from its red, green and blue.
std::vector<std::byte> jpeg_of_ramp() {
  std::vector<unsigned char> rgb;
  for (int i = 0; i < kSize.height; ++i) {
    for (int j = 0; j < kSize.width; ++j) {
      rgb.insert(rgb.end(), {static_cast<unsigned char>(j), static_cast<unsigned char>(i), 40});
    }
  }
  const std::unique_ptr<void, int (*)(void*)> handle(tjInitCompress(), tjDestroy);
  unsigned char* bytes = nullptr;
  unsigned long length = 0;
  tjCompress2(handle.get(), rgb.data(), kSize.width, 0, kSize.height, TJPF_RGB, &bytes, &length,
              TJSAMP_420, 95, 0);
  const auto* const first = reinterpret_cast<const std::byte*>(bytes);
  std::vector<std::byte> jpeg(first, first + length);
  tjFree(bytes);
  return jpeg;
}

TEST(LumaDecoder, GivesTheLumaPlane) {
  LumaDecoder decoder;
  const ImageView luma = decoder.decode(jpeg_of_ramp(), kSize);
  ASSERT_EQ(luma.size, kSize);
  for (int i = 0; i < kSize.height; ++i) {
    for (int j = 0; j < kSize.width; ++j) {
      const auto at = static_cast<std::size_t>(i * luma.planes[0].stride + j);
      EXPECT_NEAR(std::to_integer<int>(luma.planes[0].bytes[at]),
                  0.299 * j + 0.587 * i + 0.114 * 40, 3);
    }
  }
}

TEST(LumaDecoder, RefusesWhatIsDamagedOrOfAnotherSizeAndGoesOn) {
  LumaDecoder decoder;
  const std::vector<std::byte> jpeg = jpeg_of_ramp();
  EXPECT_THROW(decoder.decode({}, kSize), BadFrame);
  EXPECT_THROW(decoder.decode(std::span(jpeg).first(jpeg.size() / 2), kSize), BadFrame);
  EXPECT_THROW(decoder.decode(jpeg, {120, 160}), BadFrame);
  std::vector<std::byte> noise(1000, std::byte{0x5a});
  EXPECT_THROW(decoder.decode(noise, kSize), BadFrame);
  EXPECT_EQ(decoder.decode(jpeg, kSize).size, kSize);
}

// The ramp with so many bytes put before its end marker.
std::vector<std::byte> padded_ramp(std::size_t bytes, std::byte value = std::byte{0}) {
  std::vector<std::byte> jpeg = jpeg_of_ramp();
  jpeg.insert(jpeg.end() - 2, bytes, value);
  return jpeg;
}

TEST(LumaDecoder, TakesAWholePictureWithAFewBytesTooManyAtItsEnd) {
  LumaDecoder decoder;
  const ImageView plain = decoder.decode(jpeg_of_ramp(), kSize);
  const std::vector<std::byte> expected(plain.planes[0].bytes.begin(), plain.planes[0].bytes.end());
  for (const std::size_t bytes : {1, 2, 4, 16}) {
    const ImageView luma = decoder.decode(padded_ramp(bytes), kSize);
    EXPECT_TRUE(std::ranges::equal(luma.planes[0].bytes, expected)) << bytes;
  }
}

TEST(LumaDecoder, RefusesAPictureThatLacksCodesOrLeavesManyOver) {
  LumaDecoder decoder;
  const std::vector<std::byte> jpeg = jpeg_of_ramp();
  for (const std::size_t missing : {20, 200, 1000}) {
    std::vector<std::byte> cut = jpeg;
    cut.erase(cut.end() - 2 - static_cast<std::ptrdiff_t>(missing), cut.end() - 2);
    EXPECT_THROW(decoder.decode(cut, kSize), BadFrame) << missing;
    cut.insert(cut.end() - 2, 4, std::byte{0});  // is no excuse for it
    EXPECT_THROW(decoder.decode(cut, kSize), BadFrame) << missing;
  }
  std::vector<std::byte> broken = jpeg;
  const auto middle = broken.begin() + static_cast<std::ptrdiff_t>(broken.size() / 2);
  std::fill_n(middle, 200, std::byte{0xfe});  // no codes
  broken.insert(broken.end() - 2, 4, std::byte{0});
  EXPECT_THROW(decoder.decode(broken, kSize), BadFrame);
  EXPECT_THROW(decoder.decode(padded_ramp(1000, std::byte{0x5a}), kSize), BadFrame);
}

}  // namespace
}  // namespace bole
