#include "capture/replay/faults.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <set>
#include <thread>
#include <vector>

#include "base/files.h"
#include "capture/replay/replay_source.h"
#include "capture/supervisor.h"
#include "support/config_problem.h"
#include "support/temporary_folder.h"

namespace bole {
namespace {

using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;

// Forty frames at 10 Hz through the supervisor in lockstep: what came of them, and when.
struct Drive {
  std::vector<std::int64_t> seqs;
  std::vector<std::int64_t> utimes_ms;
  std::vector<std::int64_t> clock_ms;
  std::vector<std::string> events;
  CaptureCounts counts;
};

Drive run_with(const std::string& script) {
  const TemporaryFolder folder;
  for (int i = 0; i < 40; ++i) folder.write(std::to_string(100 + i) + ".grey", "12345678");
  ReplayOptions options;
  options.path = folder.path();
  options.size = {4, 2};
  options.pace.kind = ReplayPace::Kind::lockstep;
  ReplayClock clock;
  const auto source = make_faulty_source(make_replay_source(options, clock),
                                         read_faults(folder.write("faults.toml", script)), clock);
  Drive run;
  Supervisor supervisor(*source, clock, [&](const CameraEvent& event) {
    run.events.push_back(std::to_string(clock.mono_ns() / 1'000'000) + " ms " +
                         std::string(name(event.state)));
  });
  for (Grab grab = supervisor.next(); grab.kind != Grab::Kind::end; grab = supervisor.next()) {
    if (grab.kind != Grab::Kind::frame) continue;
    run.seqs.push_back(grab.frame.sensor_seq());
    run.utimes_ms.push_back(grab.frame.stamp().ns / 1'000'000);
    run.clock_ms.push_back(clock.mono_ns() / 1'000'000);
  }
  run.counts = supervisor.counts();
  return run;
}

std::vector<std::int64_t> all_but(std::int64_t from, std::int64_t to) {
  std::vector<std::int64_t> seqs;
  for (std::int64_t i = 0; i < 40; ++i) {
    if (i < from || i >= to) seqs.push_back(i);
  }
  return seqs;
}

TEST(Faults, NoneLeaveEverythingAsItIs) {
  const Drive run = run_with("");
  EXPECT_EQ(run.seqs, all_but(0, 0));
  EXPECT_EQ(run.counts.drops.total(), 0);
}

TEST(Faults, DroppedFramesAreMissing) {
  const Drive run = run_with("[[fault]]\nkind = \"drop\"\nframe = 5\ncount = 3\n");
  EXPECT_EQ(run.seqs, all_but(5, 8));
  EXPECT_EQ(run.counts.drops[DropCause::missing], 3);
}

TEST(Faults, CorruptFramesAreDamaged) {
  const Drive run = run_with("[[fault]]\nkind = \"corrupt\"\nat_s = 0.5\ncount = 2\n");
  EXPECT_EQ(run.seqs, all_but(5, 7));
  EXPECT_EQ(run.counts.drops[DropCause::damaged], 2);
  EXPECT_EQ(run.counts.drops.total(), 2);
}

TEST(Faults, DuplicatesComeAgainAsTheyWere) {
  const Drive run = run_with("[[fault]]\nkind = \"duplicate\"\nframe = 39\ncount = 2\n");
  EXPECT_EQ(run.seqs.size(), 42U);
  EXPECT_EQ(std::vector(run.seqs.end() - 3, run.seqs.end()), std::vector<std::int64_t>(3, 39));
  EXPECT_EQ(std::vector(run.utimes_ms.end() - 3, run.utimes_ms.end()),
            std::vector<std::int64_t>(3, 3900));
}

TEST(Faults, AStallIsSeenAndOver) {
  const Drive run = run_with("[[fault]]\nkind = \"stall\"\nat_s = 1\nduration_s = 1.5\n");
  EXPECT_EQ(run.seqs, all_but(10, 25));
  EXPECT_THAT(run.events, ElementsAre("0 ms opening", "0 ms streaming", "1400 ms stalled",
                                      "2500 ms streaming"));
}

TEST(Faults, AnUnpluggedCameraIsToldAtOnceAndComesBack) {
  const Drive run = run_with("[[fault]]\nkind = \"unplug\"\nat_s = 1\nduration_s = 1.5\n");
  ASSERT_EQ(run.events.size(), 5U);
  EXPECT_EQ(run.events[2], "1000 ms no camera");
  EXPECT_EQ(run.events[4], std::to_string(run.clock_ms.at(10)) + " ms streaming");
  EXPECT_LE(run.clock_ms.at(10), 2500 + 400 + 100) << "a back-off and a frame after the replug";
  EXPECT_EQ(run.counts.losses, 1);
}

TEST(Faults, LateFramesComeAfterTheirTimeWithTheirStamp) {
  const Drive run = run_with("[[fault]]\nkind = \"late\"\nframe = 39\nduration_s = 0.25\n");
  EXPECT_EQ(run.utimes_ms.back(), 3900);
  EXPECT_EQ(run.clock_ms.back(), 4150);
  EXPECT_EQ(run.clock_ms.at(38), 3800);
}

TEST(Faults, AClockStepMovesTheStampsFromThereOn) {
  const Drive run = run_with("[[fault]]\nkind = \"clock_step\"\nframe = 2\nstep_s = -3600\n");
  EXPECT_EQ(run.utimes_ms.at(1), 100);
  EXPECT_EQ(run.utimes_ms.at(2), 200 - 3'600'000);
  EXPECT_EQ(run.clock_ms.at(2), 200);
}

TEST(Faults, ThatAreNoneAreRefused) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& script) {
    return test::config_problem([&] { read_faults(folder.write("faults.toml", script)); });
  };
  EXPECT_THAT(refused("[[fault]]\nkind = \"explode\"\nframe = 1\n"), HasSubstr("fault[0].kind"));
  EXPECT_THAT(refused("[[fault]]\nframe = 1\n"), HasSubstr("fault[0].kind: is missing"));
  EXPECT_THAT(refused("[[fault]]\nkind = \"drop\"\n"), HasSubstr("give one of the two"));
  EXPECT_THAT(refused("[[fault]]\nkind = \"drop\"\nframe = 1\nat_s = 1\n"),
              HasSubstr("give one of the two"));
  EXPECT_THAT(refused("[[fault]]\nkind = \"stall\"\nframe = 1\n"), HasSubstr("duration_s"));
  EXPECT_THAT(refused("[[fault]]\nkind = \"drop\"\nframe = 1\nstep_s = 1\n"),
              HasSubstr("step_s: is not a known key"));
  EXPECT_THAT(refused("fault = 3\n"), HasSubstr("[[fault]]"));
  EXPECT_THAT(refused("[fault]\nkind = \"drop\"\n"), HasSubstr("[[fault]]"));
}

TEST(Faults, InterruptEndsTheWaitForALateFrame) {
  const TemporaryFolder folder;
  ReplayOptions options;
  options.path = folder.write("1.grey", "12345678");
  options.size = {4, 2};
  SystemClock clock;
  Fault late;
  late.kind = Fault::Kind::late;
  late.duration_s = 1000;
  const auto source = make_faulty_source(make_replay_source(options, clock), {late}, clock);
  source->open();
  ASSERT_EQ(source->grab(std::chrono::milliseconds(20)).kind, Grab::Kind::timeout);
  std::thread other([&] { source->interrupt(); });
  EXPECT_EQ(source->grab(std::chrono::minutes(1)).kind, Grab::Kind::interrupted);
  other.join();
}

TEST(Faults, TheExampleThatShipsShowsEveryKind) {
  const std::filesystem::path example = BOLE_SOURCE_DIR "/examples/faults.toml";
  std::set<Fault::Kind> kinds;
  for (const Fault& fault : read_faults(example)) kinds.insert(fault.kind);
  EXPECT_EQ(kinds.size(), 7U);

  const Drive run = run_with(read_text_file(example, 1 << 20));
  const auto times = [&](std::int64_t seq) { return std::ranges::count(run.seqs, seq); };
  const auto place = [&](std::int64_t seq) {
    return static_cast<std::size_t>(std::ranges::find(run.seqs, seq) - run.seqs.begin());
  };
  EXPECT_EQ(times(2), 1);
  EXPECT_EQ(times(3) + times(4), 0) << "dropped";
  EXPECT_EQ(times(6), 3) << "duplicated";
  EXPECT_EQ(run.counts.drops[DropCause::damaged], 1);
  EXPECT_EQ(run.clock_ms.at(place(10)), 1050) << "late";
  EXPECT_EQ(run.utimes_ms.at(place(12)), 1200 - 3'600'000) << "a stepped clock";
  EXPECT_EQ(run.counts.stalls, 1);
  EXPECT_EQ(run.counts.losses, 1);
  EXPECT_EQ(times(39), 1) << "it comes back";
}

}  // namespace
}  // namespace bole
