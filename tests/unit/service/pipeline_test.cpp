#include "service/pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "capture/frame_pool.h"
#include "warp/camera_files.h"

namespace bole {
namespace {

constexpr ImageSize kSize{640, 480};

// A camera whose JPEG frames are damaged, until it was opened for the third time. Then it gives ten
// good frames and ends, or when nobody opens it.
class DamagedJpegCamera : public FrameSource {
 public:
  explicit DamagedJpegCamera(ReplayClock& clock) : clock_(clock) {}

  void open() override { ++opened; }
  Grab grab(std::chrono::nanoseconds) override {
    clock_.advance_to(clock_.mono_ns() + frame_period().count());
    const bool good = opened == 3;
    Grab grab;
    if ((good && ++good_frames_ > 10) || seq_ > 1000) {
      grab.kind = Grab::Kind::end;
      return grab;
    }
    const int index = pool_->take();
    FrameSlot& slot = pool_->slot(index);
    slot.format = good ? PixelFormat::grey : PixelFormat::mjpeg;
    slot.size = kSize;
    slot.bytes.assign(good ? packed_frame_bytes(slot.format, kSize) : 1000, std::byte{0x5a});
    const std::int64_t now_ns = clock_.mono_ns();
    grab.kind = Grab::Kind::frame;
    grab.frame = pool_->frame(index, {StampClock::replay, now_ns, now_ns}, seq_++);
    return grab;
  }
  void close() noexcept override {}
  void interrupt() noexcept override {}
  std::chrono::nanoseconds frame_period() const override { return std::chrono::milliseconds(50); }
  std::string description() const override { return "a camera"; }

  int opened = 0;

 private:
  ReplayClock& clock_;
  std::shared_ptr<FramePool> pool_ = FramePool::make();
  int good_frames_ = 0;
  std::int64_t seq_ = 0;
};

// That a JPEG is damaged shows in processing alone.
TEST(Pipeline, RestartsACameraOfWhichNoFrameCanBeUsed) {
  const Camera camera = load_camera(BOLE_SOURCE_DIR "/tests/hil/cameras/640x480/camera.toml");
  const WarpTable table = build_warp_table(camera);
  ReplayClock clock;
  DamagedJpegCamera source(clock);
  Processor processor(table, camera.config.mount.height, camera.config.search, {}, clock);
  Telemetry telemetry("1.0", "front");
  Pipeline pipeline(source, clock, processor, telemetry, {}, true, nullptr);
  pipeline.run(-1);

  EXPECT_EQ(source.opened, 3);
  const status_t status = telemetry.status(0, false);
  EXPECT_EQ(status.state, status_t::STATE_STREAMING);
  EXPECT_EQ(status.lists, 10);
  const auto count_of = [&](const std::string& name) {
    return std::ranges::find(status.camera_events, name, &counter_t::name)->count;
  };
  EXPECT_EQ(count_of("stalls"), 1);
  EXPECT_EQ(count_of("restarts"), 2);
}

}  // namespace
}  // namespace bole
