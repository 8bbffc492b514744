#include "warp/luma_decoder.h"

#include <gtest/gtest.h>

#include "support/ramp_jpeg.h"
#include "warp/bad_frame.h"

namespace bole {
namespace {

constexpr ImageSize kSize{160, 120};

std::vector<std::byte> jpeg_of_ramp() { return test::ramp_jpeg(kSize); }

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
