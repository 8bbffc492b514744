// What of the V4L2 source needs no camera; the rig in tests/hil has cameras.
#include <gmock/gmock.h>

#include <array>
#include <numeric>
#include <vector>

#include "capture/buffer_layout.h"
#include "capture/frame_pool.h"
#include "capture/sequence_count.h"
#include "capture/v4l2/controls.h"
#include "capture/v4l2/format.h"
#include "capture/v4l2/stamp.h"
#include "capture/v4l2/v4l2_source.h"
#include "support/temporary_folder.h"

namespace bole {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kMonoNow = 5'000 * kSecond;
constexpr std::int64_t kUtcNow = 1'700'000'000 * kSecond;

v4l2_buffer stamped(std::int64_t ns, std::uint32_t flags) {
  v4l2_buffer buffer{};
  buffer.timestamp = {ns / kSecond, ns % kSecond / 1000};
  buffer.flags = flags;
  return buffer;
}

TEST(V4l2Stamp, IsTheDriversOnItsOwnClock) {
  const V4l2Stamp read = read_stamp(
      stamped(kMonoNow - 40'000'000, V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC), kMonoNow, kUtcNow);
  EXPECT_EQ(read.stamp.clock, StampClock::monotonic);
  EXPECT_EQ(read.stamp.ns, kMonoNow - 40'000'000);
  EXPECT_FALSE(read.corrected);
}

TEST(V4l2Stamp, InTheFutureBecomesNow) {
  const V4l2Stamp read = read_stamp(
      stamped(kMonoNow + 170'000'000, V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC), kMonoNow, kUtcNow);
  EXPECT_EQ(read.stamp.ns, kMonoNow);
  EXPECT_TRUE(read.corrected);
}

TEST(V4l2Stamp, ThatIsNoneBecomesNow) {
  const V4l2Stamp read = read_stamp(stamped(0, 0), kMonoNow, kUtcNow);
  EXPECT_EQ(read.stamp.clock, StampClock::monotonic);
  EXPECT_EQ(read.stamp.ns, kMonoNow);
  EXPECT_TRUE(read.corrected);
}

TEST(V4l2Stamp, OfAnUnknownClockIsOfTheNearerOne) {
  const V4l2Stamp utc = read_stamp(stamped(kUtcNow - kSecond, 0), kMonoNow, kUtcNow);
  EXPECT_EQ(utc.stamp.clock, StampClock::realtime);
  EXPECT_EQ(utc.stamp.ns, kUtcNow - kSecond);
  EXPECT_FALSE(utc.corrected);
  const V4l2Stamp mono = read_stamp(stamped(kMonoNow - kSecond, 0), kMonoNow, kUtcNow);
  EXPECT_EQ(mono.stamp.clock, StampClock::monotonic);
}

TEST(V4l2Sequence, GoesOnWhereThirtyTwoBitsEnd) {
  SequenceCount count;
  EXPECT_EQ(count.extend(0xffff'fffe), 0xffff'fffe);
  EXPECT_EQ(count.extend(1), 0x1'0000'0001);
  EXPECT_EQ(count.extend(5), 0x1'0000'0005);
}

TEST(V4l2Sequence, ThatBeginsAnewOrStandsStillIsNoGap) {
  SequenceCount count;
  EXPECT_EQ(count.extend(100), 100);
  EXPECT_EQ(count.extend(0), 101);
  EXPECT_EQ(count.extend(0), 101);
}

class ViewBuffer : public testing::Test {
 protected:
  ViewBuffer() {
    std::iota(reinterpret_cast<unsigned char*>(bytes.data()),
              reinterpret_cast<unsigned char*>(bytes.data() + bytes.size()), 0);
  }
  std::span<const std::byte> part(std::size_t begin, std::size_t size) const {
    return std::span(bytes).subspan(begin, size);
  }
  std::optional<ImageView> view(std::span<const std::byte> first,
                                std::span<const std::byte> second = {}) const {
    const std::array areas = {first, second};
    return view_buffer(format, areas);
  }

  std::array<std::byte, 256> bytes{};
  BufferLayout format;
};

TEST_F(ViewBuffer, KeepsThePaddingOfRows) {
  format.pixels = PixelFormat::yuyv;
  format.size = {4, 3};
  format.strides = {16, 16};
  const std::optional<ImageView> image = view(part(0, 48));
  ASSERT_TRUE(image);
  EXPECT_EQ(image->planes[0].stride, 16);
  EXPECT_EQ(image->planes[0].bytes[32], bytes[32]);
}

TEST_F(ViewBuffer, NeedsTheLastRowButNotItsPadding) {
  format.pixels = PixelFormat::yuyv;
  format.size = {4, 3};
  format.strides = {16, 16};
  EXPECT_TRUE(view(part(0, 40)));
  EXPECT_FALSE(view(part(0, 39)));
  EXPECT_FALSE(view(part(0, 0)));
}

TEST_F(ViewBuffer, FindsChromaBehindLumaOrInItsOwnMemory) {
  format.pixels = PixelFormat::nv12;
  format.size = {4, 4};
  format.strides = {8, 8};
  std::optional<ImageView> image = view(part(0, 48));
  ASSERT_TRUE(image);
  EXPECT_EQ(image->planes[1].bytes.data(), bytes.data() + 32);
  EXPECT_EQ(image->planes[1].bytes.size(), 16U);
  EXPECT_FALSE(view(part(0, 43)));

  format.memory_planes = 2;
  image = view(part(0, 32), part(128, 16));
  ASSERT_TRUE(image);
  EXPECT_EQ(image->planes[1].bytes.data(), bytes.data() + 128);
  EXPECT_FALSE(view(part(0, 32), part(128, 8)));
}

TEST_F(ViewBuffer, TakesJpegAsLongAsItIs) {
  format.pixels = PixelFormat::mjpeg;
  format.size = {640, 480};
  EXPECT_EQ(view(part(0, 77))->planes[0].bytes.size(), 77U);
  EXPECT_FALSE(view(part(0, 0)));
}

TEST(V4l2Formats, AreNamedAsVideo4LinuxNamesThem) {
  EXPECT_EQ(pixel_format_of(V4L2_PIX_FMT_YUYV), PixelFormat::yuyv);
  EXPECT_EQ(pixel_format_of(V4L2_PIX_FMT_NV12M), PixelFormat::nv12);
  EXPECT_EQ(pixel_format_of(V4L2_PIX_FMT_SBGGR8), PixelFormat::bggr);
  EXPECT_EQ(pixel_format_of(V4L2_PIX_FMT_H264), std::nullopt);
  EXPECT_EQ(fourcc_text(V4L2_PIX_FMT_YUYV), "YUYV");
  EXPECT_EQ(fourcc_text(V4L2_PIX_FMT_Y16), "Y16.");
}

std::string why_it_does_not_open(const std::string& device) {
  const SystemClock clock;
  CameraSettings settings;
  settings.size = {640, 480};
  const auto source = make_v4l2_source(device, settings, clock);
  try {
    source->open();
  } catch (const CaptureError& error) {
    return error.what();
  }
  return "it opened";
}

TEST(V4l2Source, TellsWhyACameraCannotBeOpened) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(why_it_does_not_open("/dev/v4l/by-id/usb-none"),
            "is not there (/dev/v4l/by-id/usb-none); plug it in, or choose from bolectl cameras");
  EXPECT_THAT(why_it_does_not_open("no-such-serial"), HasSubstr("is not there (no-such-serial);"));
  EXPECT_THAT(why_it_does_not_open("/dev/null"), HasSubstr("is no Video4Linux device"));
  EXPECT_THAT(why_it_does_not_open(""), HasSubstr("is not there ();"));
}

// /dev/null opens, but has no settings.
TEST(V4l2Device, TellsBeforeEachQuestionAndCanBeStoppedThere) {
  int questions = 0;
  const V4l2Device device("/dev/null", [&] {
    if (++questions == 3) throw CaptureError("interrupted");
  });
  CameraSettings settings;
  settings.exposure = CameraSettings::Exposure::automatic;
  settings.power_line = CameraSettings::PowerLine::off;
  settings.white_balance = CameraSettings::WhiteBalance::automatic;
  EXPECT_THROW(apply_controls(device, settings), CaptureError);
  EXPECT_EQ(questions, 3);
}

TEST(V4l2Controls, ThatAreRefusedAreToldAsTheyWereAskedFor) {
  const V4l2Device device("/dev/null");
  CameraSettings settings;
  settings.exposure = CameraSettings::Exposure::metered;
  settings.white_balance = CameraSettings::WhiteBalance::automatic;
  settings.power_line = CameraSettings::PowerLine::hz50;
  EXPECT_THAT(
      apply_controls(device, settings),
      ElementsAre(StartsWith("exposure = \"metered\": "), StartsWith("exposure_us = 10000: "),
                  StartsWith("white_balance = \"automatic\": "),
                  StartsWith("power_line = \"50 Hz\": ")));
}

TEST(Grab, HoldsTheNewestGoodFrameAndCountsTheOthers) {
  const auto pool = FramePool::make();
  const auto frame = [&](std::int64_t seq) {
    const int slot = pool->take();
    pool->slot(slot).size = {1, 1};
    pool->slot(slot).bytes.resize(1);
    return pool->frame(slot, {}, seq);
  };
  Grab grab;
  grab.refuse(DropCause::damaged, "damaged");
  EXPECT_EQ(grab.kind, Grab::Kind::bad_frame);
  grab.take(frame(1), true);
  grab.take(frame(2), false);
  grab.refuse(DropCause::too_short, "short");
  EXPECT_EQ(grab.kind, Grab::Kind::frame);
  EXPECT_EQ(grab.frame.sensor_seq(), 2);
  EXPECT_EQ(grab.stamps_corrected, 1);
  EXPECT_EQ(grab.drops[DropCause::superseded], 1);
  EXPECT_EQ(grab.drops.total(), 3);
  EXPECT_EQ(grab.reason, "short");
  grab.lose("is not there");
  EXPECT_EQ(grab.kind, Grab::Kind::lost);
  EXPECT_FALSE(grab.frame);
}

}  // namespace
}  // namespace bole
