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

}  // namespace
}  // namespace bole
