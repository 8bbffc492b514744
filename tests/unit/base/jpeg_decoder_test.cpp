#include "base/jpeg_decoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "support/ramp_jpeg.h"

namespace bole {
namespace {

using Bytes = std::vector<std::byte>;

constexpr ImageSize kSize{160, 120};

Bytes jpeg_of_ramp(int interval = 0) { return test::ramp_jpeg(kSize, interval); }

Bytes decoded(JpegDecoder& decoder, const Bytes& jpeg) {
  const JpegDecoder::Header header = decoder.read_header(jpeg);
  EXPECT_EQ(header.size, kSize);
  Bytes pixels(packed_frame_bytes(PixelFormat::bgr24, kSize));
  decoder.decode(PixelFormat::bgr24, pixels);
  return pixels;
}

Bytes decoded(const Bytes& jpeg) {
  JpegDecoder decoder;
  return decoded(decoder, jpeg);
}

// With so many bytes put before its end marker.
Bytes padded(Bytes jpeg, std::size_t bytes, std::byte value = std::byte{0}) {
  jpeg.insert(jpeg.end() - 2, bytes, value);
  return jpeg;
}

bool is_restart(std::byte first, std::byte second) {
  return first == std::byte{0xff} && (second & std::byte{0xf8}) == std::byte{0xd0};
}

// With so many bytes put before every second restart marker.
Bytes padded_between(const Bytes& jpeg, std::size_t bytes) {
  Bytes result;
  bool chosen = false;
  for (std::size_t i = 0; i < jpeg.size(); ++i) {
    if (i + 1 < jpeg.size() && is_restart(jpeg[i], jpeg[i + 1])) {
      chosen = !chosen;
      if (chosen) result.insert(result.end(), bytes, std::byte{0});
    }
    result.push_back(jpeg[i]);
  }
  return result;
}

TEST(JpegDecoder, GivesThePixelsThatOpenCvDoes) {
  const Bytes jpeg = jpeg_of_ramp();
  const cv::Mat file(1, static_cast<int>(jpeg.size()), CV_8UC1,
                     const_cast<std::byte*>(jpeg.data()));
  const cv::Mat expected = cv::imdecode(file, cv::IMREAD_COLOR);
  EXPECT_TRUE(std::ranges::equal(decoded(jpeg),
                                 std::as_bytes(std::span(expected.data, expected.total() * 3))));
}

TEST(JpegDecoder, TakesAWholePictureWithAFewBytesTooManyAtItsEnd) {
  const Bytes jpeg = jpeg_of_ramp();
  for (const std::size_t bytes : {1, 2, 4, 16, 64}) {
    EXPECT_TRUE(decoded(padded(jpeg, bytes)) == decoded(jpeg)) << bytes;
  }
}

TEST(JpegDecoder, TakesAWholePictureWithAFewBytesTooManyBeforeItsRestartMarkers) {
  const Bytes jpeg = jpeg_of_ramp(10);
  for (const std::size_t bytes : {1, 2, 4, 9}) {
    const Bytes cheap = padded_between(jpeg, bytes);
    ASSERT_GT(cheap.size(), jpeg.size() + 2 * bytes);
    EXPECT_TRUE(decoded(cheap) == decoded(jpeg)) << bytes;
  }
}

TEST(JpegDecoder, RefusesAPictureThatLeavesManyBytesOver) {
  EXPECT_THROW(decoded(padded(jpeg_of_ramp(), 1000, std::byte{0x5a})), DamagedJpeg);
  EXPECT_THROW(decoded(padded_between(jpeg_of_ramp(10), 100)), DamagedJpeg);
}

TEST(JpegDecoder, RefusesAPictureThatLacksCodes) {
  const Bytes jpeg = jpeg_of_ramp();
  for (const std::size_t missing : {20, 200, 1000}) {
    Bytes cut = jpeg;
    cut.erase(cut.end() - 2 - static_cast<std::ptrdiff_t>(missing), cut.end() - 2);
    EXPECT_THROW(decoded(cut), DamagedJpeg) << missing;
    EXPECT_THROW(decoded(padded(cut, 4)), DamagedJpeg) << missing;  // is no excuse for it
  }
}

TEST(JpegDecoder, RefusesAPictureThatLacksAnInterval) {
  Bytes jpeg = padded_between(jpeg_of_ramp(10), 2);
  const auto first = std::ranges::adjacent_find(jpeg, is_restart);
  const auto second = std::ranges::adjacent_find(first + 2, jpeg.end(), is_restart);
  ASSERT_NE(second, jpeg.end());
  jpeg.erase(first, second);
  EXPECT_THROW(decoded(jpeg), DamagedJpeg);
}

TEST(JpegDecoder, RefusesWhatIsBrokenInside) {
  Bytes jpeg = jpeg_of_ramp();
  const auto middle = jpeg.begin() + static_cast<std::ptrdiff_t>(jpeg.size() / 2);
  std::fill_n(middle, 200, std::byte{0xfe});  // no codes
  EXPECT_THROW(decoded(padded(jpeg, 4)), DamagedJpeg);
}

TEST(JpegDecoder, SaysWhyItRefusesAndGoesOn) {
  JpegDecoder decoder;
  const Bytes jpeg = jpeg_of_ramp(), half(jpeg.begin(), jpeg.begin() + jpeg.size() / 2);
  EXPECT_THROW(decoder.read_header({}), DamagedJpeg);
  try {
    decoded(decoder, half);
    FAIL() << "half of it was taken";
  } catch (const DamagedJpeg& damage) {
    EXPECT_STREQ(damage.what(), "Premature end of JPEG file");
  }
  decoder.read_header(jpeg);  // and then another picture
  EXPECT_TRUE(decoded(decoder, jpeg) == decoded(jpeg));
}

}  // namespace
}  // namespace bole
