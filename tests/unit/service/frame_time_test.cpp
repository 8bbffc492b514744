#include "service/frame_time.h"

#include <gtest/gtest.h>

namespace bole {
namespace {

// A clock that stands still where it is put.
class StillClock : public Clock {
 public:
  StillClock(std::int64_t mono_ns, std::int64_t utc_us) : mono_ns_(mono_ns), utc_us_(utc_us) {}
  std::int64_t mono_ns() const override { return mono_ns_; }
  std::int64_t utc_us() const override { return utc_us_; }
  bool sleep_until(std::int64_t /*deadline_ns*/, const Wakeup& /*wakeup*/) override { return true; }

 private:
  std::int64_t mono_ns_, utc_us_;
};

TEST(FrameTime, AMonotonicStampIsMappedToUtc) {
  const FrameTime time =
      frame_time({StampClock::monotonic, 4'000'000'000, 0}, StillClock(5'000'000'000, 70'000'000));
  EXPECT_EQ(time.mono_ns, 4'000'000'000);
  EXPECT_EQ(time.utc_us, 69'000'000);
  EXPECT_EQ(time.scene_ns, time.mono_ns);
}

TEST(FrameTime, AStepOfUtcMovesTheNextFrameWithIt) {
  const FrameStamp stamp{StampClock::monotonic, 4'000'000'000, 0};
  const auto before = frame_time(stamp, StillClock(5'000'000'000, 70'000'000));
  const auto after = frame_time(stamp, StillClock(5'000'000'000, 10'000'000));
  EXPECT_EQ(before.utc_us - after.utc_us, 60'000'000);
  EXPECT_EQ(before.mono_ns, after.mono_ns);
}

TEST(FrameTime, ARealtimeStampIsMappedToMonotonic) {
  const FrameTime time =
      frame_time({StampClock::realtime, 69'500'000'000, 0}, StillClock(5'000'000'000, 70'000'000));
  EXPECT_EQ(time.utc_us, 69'500'000);
  EXPECT_EQ(time.mono_ns, 4'500'000'000);
  EXPECT_EQ(time.scene_ns, time.mono_ns);
}

TEST(FrameTime, AReplayedStampIsTakenAsItIs) {
  const FrameTime time =
      frame_time({StampClock::replay, 1'234'567'000, 42}, StillClock(5'000'000'000, 70'000'000));
  EXPECT_EQ(time.utc_us, 1'234'567);
  EXPECT_EQ(time.mono_ns, 42);
  EXPECT_EQ(time.scene_ns, 1'234'567'000) << "not when the replay let it happen";
}

}  // namespace
}  // namespace bole
