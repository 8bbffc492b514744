#include "replayed.h"

#include <mutex>
#include <optional>
#include <thread>

namespace bole {
namespace {

using namespace test;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Replay, LoopsWithTimeThatGoesOn) {
  const TemporaryFolder folder = folder_of(2);
  folder.write("timestamps.csv", "f0.grey,1000000\nf1.grey,1250000\n");
  ReplayOptions options = options_for(folder.path());
  options.loop = true;
  const Replayed seen = replay(options, 5);
  EXPECT_THAT(utimes_of(seen), ElementsAre(1'000'000, 1'250'000, 1'500'000, 1'750'000, 2'000'000));
  EXPECT_EQ(seen.frames[4].seq, 4);
  EXPECT_EQ(seen.frames[4].file, "f0.grey");
}

TEST(Replay, StartAndEndAreSecondsFromTheFirstFrame) {
  const TemporaryFolder folder = folder_of(6);
  ReplayOptions options = options_for(folder.path());
  options.start_s = 0.15;
  options.end_s = 0.4;
  const Replayed seen = replay(options);
  EXPECT_THAT(files_of(seen), ElementsAre("f2.grey", "f3.grey"));
  EXPECT_EQ(seen.frames[0].seq, 0);
  options.loop = true;
  EXPECT_THAT(utimes_of(replay(options, 4)), ElementsAre(200'000, 300'000, 400'000, 500'000));
  options.start_s = 9;
  options.end_s = 10;
  EXPECT_THAT(refusal(options), HasSubstr("no frame between start and end"));
  options.end_s = 1;
  EXPECT_THAT(refusal(options), HasSubstr("no span of time"));
}

TEST(Replay, LockstepSetsTheClockToEachStamp) {
  const TemporaryFolder folder = folder_of(3);
  folder.write("timestamps.csv", "f0.grey,5000000\nf1.grey,5100000\nf2.grey,99000000\n");
  ReplayClock clock;
  const auto source = make_replay_source(options_for(folder.path()), clock);
  source->open();
  for (const std::int64_t utime_us : {5'000'000, 5'100'000, 99'000'000}) {
    const Grab grab = source->grab(milliseconds(1));
    ASSERT_EQ(grab.kind, Grab::Kind::frame);
    EXPECT_EQ(clock.utc_us(), utime_us);
    EXPECT_EQ(grab.frame.stamp().mono_ns, clock.mono_ns());
  }
  EXPECT_EQ(source->grab(milliseconds(1)).kind, Grab::Kind::end);
}

TEST(Replay, RealtimeHoldsFramesBackUntilTheirTime) {
  const TemporaryFolder folder = folder_of(2);
  ReplayClock clock(1'000'000'000);
  const auto source =
      make_replay_source(options_for(folder.path(), ReplayPace::Kind::realtime), clock);
  source->open();
  EXPECT_EQ(source->grab(milliseconds(40)).frame.stamp().mono_ns, 1'000'000'000);
  EXPECT_EQ(source->grab(milliseconds(40)).kind, Grab::Kind::timeout);
  EXPECT_EQ(clock.mono_ns(), 1'040'000'000);
  EXPECT_EQ(source->grab(milliseconds(60)).frame.stamp().mono_ns, 1'100'000'000);
}

TEST(Replay, WhoComesLateInRealtimeGetsTheNewestFrame) {
  const TemporaryFolder folder = folder_of(6);
  ReplayClock clock;
  const auto source =
      make_replay_source(options_for(folder.path(), ReplayPace::Kind::realtime), clock);
  source->open();
  EXPECT_EQ(source->grab(milliseconds(1)).frame.sensor_seq(), 0);
  clock.advance_to(330'000'000);
  const Grab late = source->grab(milliseconds(1));
  EXPECT_EQ(late.frame.sensor_seq(), 3);
  EXPECT_EQ(late.drops[DropCause::superseded], 2);
  clock.advance_to(9'000'000'000);
  EXPECT_EQ(source->grab(milliseconds(1)).frame.sensor_seq(), 5) << "the last one is never skipped";
}

TEST(Replay, CountsTheFramesMissedBeforeItsEnd) {
  const TemporaryFolder folder = folder_of(6);
  ReplayOptions options = options_for(folder.path(), ReplayPace::Kind::realtime);
  options.end_s = 0.35;
  ReplayClock clock;
  const auto source = make_replay_source(options, clock);
  source->open();
  EXPECT_EQ(source->grab(milliseconds(1)).frame.sensor_seq(), 0);
  clock.advance_to(9'000'000'000);
  const Grab last = source->grab(milliseconds(1));
  EXPECT_EQ(last.kind, Grab::Kind::end);
  EXPECT_EQ(last.drops[DropCause::superseded], 3);
}

TEST(Replay, RateAndFastGoByTheirOwnTime) {
  const TemporaryFolder folder = folder_of(3);
  ReplayOptions options = options_for(folder.path());
  ReplayClock clock;
  options.pace = parse_replay_pace("rate:4");
  auto source = make_replay_source(options, clock);
  source->open();
  for (const std::int64_t release_ns : {0, 250'000'000, 500'000'000}) {
    EXPECT_EQ(source->grab(seconds(1)).frame.stamp().mono_ns, release_ns);
  }
  options.pace = parse_replay_pace("fast");
  source = make_replay_source(options, clock);
  source->open();
  for (const std::int64_t utime_us : {0, 100'000, 200'000}) {
    const Grab grab = source->grab(seconds(1));
    EXPECT_EQ(grab.frame.stamp().ns, utime_us * 1000);
    EXPECT_EQ(grab.frame.stamp().mono_ns, 500'000'000);
  }
}

TEST(Replay, RestampGivesTheInstantOfRelease) {
  const TemporaryFolder folder = folder_of(2);
  ReplayOptions options = options_for(folder.path(), ReplayPace::Kind::realtime);
  options.restamp = true;
  ReplayClock clock(7'000'000'000);
  const auto source = make_replay_source(options, clock);
  source->open();
  source->grab(seconds(1));
  const Grab grab = source->grab(seconds(1));
  EXPECT_EQ(grab.frame.stamp().clock, StampClock::monotonic);
  EXPECT_EQ(grab.frame.stamp().ns, 7'100'000'000);
  options.pace.kind = ReplayPace::Kind::lockstep;
  EXPECT_THAT(refusal(options), HasSubstr("source.restamp"));
}

TEST(Replay, RefusesAPaceThatIsNone) {
  for (const char* text :
       {"", "slow", "rate", "rate:", "rate:0", "rate:-1", "rate:nan", "rate:1e9", "rate:5x"}) {
    EXPECT_THROW(parse_replay_pace(text), ConfigError) << text;
  }
  EXPECT_THAT(test::config_problem([] { parse_replay_pace("slow", "boled.toml"); }),
              HasSubstr("boled.toml: source.pace: is \"slow\""));
  EXPECT_EQ(parse_replay_pace("rate:2.5").rate_hz, 2.5);
}

TEST(Replay, InterruptEndsAWait) {
  const TemporaryFolder folder = folder_of(2);
  ReplayOptions options = options_for(folder.path());
  options.pace = parse_replay_pace("rate:0.01");
  SystemClock clock;
  const auto source = make_replay_source(options, clock);
  source->open();
  ASSERT_EQ(source->grab(seconds(1)).kind, Grab::Kind::frame);
  std::thread other([&] { source->interrupt(); });
  EXPECT_EQ(source->grab(seconds(60)).kind, Grab::Kind::interrupted);
  other.join();
}

TEST(Replay, FramesOutliveTheirSource) {
  const TemporaryFolder folder = folder_of(2);
  ReplayClock clock;
  auto source = make_replay_source(options_for(folder.path()), clock);
  source->open();
  const Grab first = source->grab(seconds(1));
  const Grab second = source->grab(seconds(1));
  source->close();
  source.reset();
  EXPECT_EQ(bytes_of(first.frame), grey_pixels('a'));
  EXPECT_EQ(bytes_of(second.frame), grey_pixels('b'));
  EXPECT_EQ(second.frame.file(), "f1.grey");
}

TEST(Replay, FramesMayBeDroppedByAnotherThread) {
  const TemporaryFolder folder = folder_of(2);
  ReplayOptions options = options_for(folder.path(), ReplayPace::Kind::fast);
  options.loop = true;
  ReplayClock clock;
  const auto source = make_replay_source(options, clock);
  source->open();
  std::mutex mutex;
  std::vector<Frame> handed_over;
  std::thread other([&] {
    for (int dropped = 0; dropped < 500;) {
      std::vector<Frame> taken;
      const std::lock_guard lock(mutex);
      taken.swap(handed_over);
      for (const Frame& frame : taken) {
        EXPECT_EQ(bytes_of(frame), grey_pixels(frame.sensor_seq() % 2 == 0 ? 'a' : 'b'));
        ++dropped;
      }
    }
  });
  for (int i = 0; i < 500; ++i) {
    Grab grab = source->grab(seconds(1));
    const std::lock_guard lock(mutex);
    handed_over.push_back(std::move(grab.frame));
  }
  other.join();
}

// A picture with something in every channel.

}  // namespace
}  // namespace bole
