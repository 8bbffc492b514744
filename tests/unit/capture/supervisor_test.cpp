#include "capture/supervisor.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <deque>
#include <functional>
#include <thread>
#include <vector>

#include "capture/frame_pool.h"

namespace bole {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::int64_t kMs = 1'000'000;

// A camera of which the test says what it does; time passes only while it is waited for.
class ScriptedCamera : public FrameSource {
 public:
  explicit ScriptedCamera(ReplayClock& clock) : clock_(clock) {}

  void open() override {
    for (int i = 0; i < steps; ++i) {
      clock_.advance_to(clock_.mono_ns() + 2000 * kMs);
      if (at_step) at_step(i);
      step(interrupted);
    }
    ++opened;
    opened_at_ms.push_back(clock_.mono_ns() / kMs);
    if (!absent.empty()) throw CaptureError(absent);
    is_open = true;
  }
  Grab grab(std::chrono::nanoseconds timeout) override {
    EXPECT_TRUE(is_open);
    Grab grab;
    if (script.empty()) {
      clock_.advance_to(clock_.mono_ns() + timeout.count());
      return grab;
    }
    grab = std::move(script.front());
    script.pop_front();
    clock_.advance_to(clock_.mono_ns() + period.count());
    return grab;
  }
  void close() noexcept override {
    is_open = false;
    ++closed;
  }
  void interrupt() noexcept override { interrupted.raise(); }
  std::chrono::nanoseconds frame_period() const override { return period; }
  std::string description() const override { return "scripted camera"; }

  void frames(std::initializer_list<std::int64_t> seqs) {
    for (const std::int64_t seq : seqs) {
      const int slot = pool_->take();
      pool_->slot(slot).size = {1, 1};
      pool_->slot(slot).bytes.resize(1);
      Grab grab;
      grab.kind = Grab::Kind::frame;
      grab.frame = pool_->frame(slot, {}, seq);
      script.push_back(std::move(grab));
    }
  }
  void other(Grab::Kind kind, const std::string& reason, DropCause cause = DropCause::damaged) {
    Grab grab;
    grab.kind = kind;
    grab.reason = reason;
    if (kind == Grab::Kind::bad_frame) grab.drops[cause] = 1;
    script.push_back(std::move(grab));
  }

  std::deque<Grab> script;
  std::string absent;  // why open() fails; empty: it does not
  std::chrono::nanoseconds period = milliseconds(100);
  bool is_open = false;
  int opened = 0;
  int closed = 0;
  std::vector<std::int64_t> opened_at_ms;
  int steps = 0;  // of open(), two seconds each
  std::function<void(int step)> at_step;
  Wakeup interrupted;

 private:
  ReplayClock& clock_;
  std::shared_ptr<FramePool> pool_ = FramePool::make();
};

class SupervisorTest : public testing::Test {
 protected:
  // Steps until `ms` on the clock, or as long as the script lasts.
  void run_until(std::int64_t ms) {
    while (clock.mono_ns() < ms * kMs) supervisor.next();
  }
  void run_script() {
    while (!camera.script.empty()) supervisor.next();
  }
  std::vector<std::string> told() const {
    std::vector<std::string> lines;
    for (const CameraEvent& event : events) {
      lines.push_back(std::string(name(event.state)) + ": " + event.reason +
                      (event.repeated ? " (again)" : ""));
    }
    return lines;
  }

  std::int64_t seq = 0;
  ReplayClock clock;
  ScriptedCamera camera{clock};
  std::vector<CameraEvent> events;
  std::vector<std::int64_t> event_ms;
  Supervisor supervisor{camera, clock, [this](const CameraEvent& event) {
                          events.push_back(event);
                          event_ms.push_back(clock.mono_ns() / kMs);
                        }};
};

TEST_F(SupervisorTest, TellsOpeningAndStreamingOnce) {
  camera.frames({0, 1, 2});
  run_script();
  EXPECT_THAT(told(),
              ElementsAre("opening: waiting for the first frame", "streaming: scripted camera"));
  EXPECT_EQ(supervisor.counts().frames, 3);
}

TEST_F(SupervisorTest, ASlowCameraIsToldToBeOpeningAndTellsOfEachStep) {
  camera.steps = 5;
  int told_of = 0;
  camera.on_step([&] { ++told_of; });
  camera.at_step = [&](int step) {
    EXPECT_EQ(supervisor.state(), CameraState::opening);
    EXPECT_EQ(told_of, step);
  };
  supervisor.next();
  EXPECT_EQ(told_of, 5);
  EXPECT_TRUE(camera.is_open);
}

TEST_F(SupervisorTest, AnInterruptionEndsASlowOpeningAndIsNoFailure) {
  camera.steps = 5;
  camera.at_step = [&](int step) {
    if (step == 2) supervisor.interrupt();
  };
  EXPECT_EQ(supervisor.next().kind, Grab::Kind::timeout);
  EXPECT_EQ(clock.mono_ns(), 3 * 2000 * kMs);
  EXPECT_EQ(supervisor.next().kind, Grab::Kind::interrupted);
  EXPECT_EQ(supervisor.counts().failed_opens, 0);
  EXPECT_THAT(told(), ElementsAre("opening: waiting for the first frame"));
}

TEST_F(SupervisorTest, WaitsForACameraThatIsNotThereYet) {
  camera.absent = "/dev/v4l/by-id/x is not there";
  run_until(5000);
  EXPECT_THAT(told(), ElementsAre("opening: waiting for the first frame",
                                  "no camera: /dev/v4l/by-id/x is not there"));
  EXPECT_EQ(supervisor.counts().failed_opens, camera.opened);
  for (std::size_t i = 1; i < camera.opened_at_ms.size(); ++i) {
    EXPECT_LE(camera.opened_at_ms[i] - camera.opened_at_ms[i - 1], 200) << "the back-off is capped";
  }
  EXPECT_LE(camera.opened, 28) << "it backs off";
  camera.absent.clear();
  camera.frames({0});
  run_script();
  EXPECT_EQ(supervisor.state(), CameraState::streaming);
}

TEST_F(SupervisorTest, TellsEachReasonOfAnOutageOnce) {
  for (int i = 0; i < 3; ++i) {
    camera.absent = "is not there";
    run_until(1000 * (2 * i + 1));
    camera.absent = "permission denied";
    run_until(1000 * (2 * i + 2));
  }
  EXPECT_THAT(told(),
              ElementsAre("opening: waiting for the first frame", "no camera: is not there",
                          "no camera: permission denied", "no camera: is not there (again)",
                          "no camera: permission denied (again)", "no camera: is not there (again)",
                          "no camera: permission denied (again)"));
}

TEST_F(SupervisorTest, AnUnpluggedCameraIsClosedToldAtOnceAndOpenedAgain) {
  camera.frames({0, 1});
  camera.other(Grab::Kind::lost, "unplugged");
  run_script();
  EXPECT_EQ(supervisor.state(), CameraState::no_camera);
  EXPECT_FALSE(camera.is_open);
  camera.frames({0, 1});
  run_script();
  EXPECT_THAT(told(),
              ElementsAre("opening: waiting for the first frame", "streaming: scripted camera",
                          "no camera: unplugged", "opening: waiting for the first frame (again)",
                          "streaming: scripted camera (again)"));
  EXPECT_EQ(supervisor.counts().losses, 1);
  EXPECT_EQ(supervisor.counts().drops.total(), 0) << "a new count of the sensor is no gap";
}

TEST_F(SupervisorTest, ACameraThatGoesAsSoonAsItIsOpenedIsTriedEverMoreSeldom) {
  for (int i = 0; i < 20; ++i) camera.other(Grab::Kind::lost, "unplugged");
  camera.period = milliseconds(0);
  run_script();
  EXPECT_GE(camera.opened_at_ms.back(), 17 * 200);
  EXPECT_FALSE(events.at(1).repeated);
  for (std::size_t i = 2; i < events.size(); ++i) {
    EXPECT_EQ(events[i].repeated, events[i].times != 10) << i;
  }
}

TEST_F(SupervisorTest, ACameraThatComesAndGoesIsToldEverMoreSeldomUntilItStreamsWell) {
  const auto logged = [&] {
    return std::ranges::count_if(events, [](const CameraEvent& event) { return !event.repeated; });
  };
  for (int i = 0; i < 200; ++i) {
    camera.frames({0});
    camera.other(Grab::Kind::lost, "unplugged");
  }
  run_script();
  EXPECT_EQ(supervisor.counts().losses, 200);
  EXPECT_EQ(logged(), 9) << "three states, each for the first, 10th and 100th time";

  camera.frames({0});
  run_script();
  EXPECT_TRUE(events.back().repeated);
  for (int i = 1; i <= 60; ++i) camera.frames({i});
  run_script();
  EXPECT_THAT(told().back(), "streaming: scripted camera") << "that it is over is told";
  EXPECT_EQ(events.back().times, 201);

  camera.other(Grab::Kind::lost, "unplugged");
  run_script();
  EXPECT_THAT(told().back(), "no camera: unplugged") << "a new outage";
  EXPECT_EQ(events.back().times, 1);
}

TEST_F(SupervisorTest, FramesOfNoUseAreAStallUntilOneIsUsedAgain) {
  const auto frames = [&](int count, const char* unusable) {
    for (int i = 0; i < count; ++i) {
      camera.frames({seq++});
      supervisor.next();
      supervisor.judged(unusable);
    }
  };
  supervisor.next();
  frames(3, "");
  frames(4, "damaged JPEG");
  frames(1, "");
  EXPECT_EQ(supervisor.state(), CameraState::streaming) << "now and then one";
  frames(15, "damaged JPEG");
  EXPECT_THAT(told().back(), "stalled: no usable frame for 0.5 s: damaged JPEG");
  frames(600, "damaged JPEG");
  EXPECT_EQ(supervisor.state(), CameraState::stalled) << "also when restarted";
  EXPECT_EQ(supervisor.counts().stalls, 1);
  EXPECT_GE(supervisor.counts().restarts, 3);
  EXPECT_LE(supervisor.counts().restarts, 6) << "it backs off";
  EXPECT_EQ(events.size(), 3U);
  frames(1, "");
  frames(1, "");
  EXPECT_EQ(supervisor.state(), CameraState::streaming);
}

TEST_F(SupervisorTest, StallsAreJudgedByTheFrameRate) {
  camera.period = milliseconds(400);
  camera.frames({0});
  run_script();
  run_until(400 + 1900);
  EXPECT_EQ(supervisor.state(), CameraState::streaming);
  run_until(400 + 2000);
  EXPECT_EQ(supervisor.state(), CameraState::stalled);
  EXPECT_THAT(told().back(), "stalled: no frame for 2.0 s");
}

TEST_F(SupervisorTest, AFastCameraStallsAfterHalfASecondAndComesBackByItself) {
  camera.period = milliseconds(10);
  camera.frames({0});
  run_script();
  run_until(600);
  EXPECT_EQ(supervisor.state(), CameraState::stalled);
  camera.frames({1});
  run_script();
  EXPECT_EQ(supervisor.state(), CameraState::streaming);
  EXPECT_EQ(camera.opened, 1);
  EXPECT_EQ(supervisor.counts().stalls, 1);
}

TEST_F(SupervisorTest, AFrozenCameraIsRestartedEverMoreSeldom) {
  camera.frames({0});
  run_script();
  run_until(120'000);
  EXPECT_EQ(supervisor.state(), CameraState::stalled);
  EXPECT_EQ(supervisor.counts().restarts, camera.opened - 1);
  EXPECT_EQ(supervisor.counts().stalls, 1);
  const auto& at_ms = camera.opened_at_ms;
  EXPECT_LE(at_ms.at(1), 3000);
  EXPECT_LE(at_ms.back() - at_ms.at(at_ms.size() - 2), 19'100) << "the back-off is capped";
  EXPECT_GE(at_ms.back() - at_ms.at(at_ms.size() - 2), 19'000);
  EXPECT_EQ(events.size(), 3U) << testing::PrintToString(told());
}

TEST_F(SupervisorTest, ACameraWithoutAFirstFrameStalls) {
  run_until(2900);
  EXPECT_EQ(supervisor.state(), CameraState::opening);
  run_until(3200);
  EXPECT_THAT(told().back(), "stalled: no first frame for 3.0 s");
}

TEST_F(SupervisorTest, BadFramesAloneAreAStall) {
  camera.frames({0});
  for (int i = 0; i < 10; ++i) camera.other(Grab::Kind::bad_frame, "has 100 of 614400 bytes");
  run_script();
  EXPECT_THAT(told().back(), "stalled: no usable frame for 0.5 s: has 100 of 614400 bytes");
  EXPECT_EQ(supervisor.counts().drops[DropCause::damaged], 10);
}

TEST_F(SupervisorTest, CountsAFrameOnceThatWasDroppedTogetherWithTheOneBeforeIt) {
  camera.frames({4, 5, 7, 9});
  camera.script[1].drops[DropCause::damaged] = 1;  // number 6, taken with number 5
  run_script();
  const DropCounts& drops = supervisor.counts().drops;
  EXPECT_EQ(drops[DropCause::damaged], 1);
  EXPECT_EQ(drops[DropCause::missing], 1);  // number 8
}

TEST_F(SupervisorTest, GapsInTheSensorsCountAreMissingUnlessDroppedKnowingly) {
  camera.frames({7, 8, 12});                              // 9 to 11 are missing
  camera.other(Grab::Kind::bad_frame, "damaged");         // this is 13
  camera.frames({14, 18});                                // of 15 to 17 ...
  camera.script.back().drops[DropCause::superseded] = 2;  // ... two were there
  run_script();
  const DropCounts& drops = supervisor.counts().drops;
  EXPECT_EQ(drops[DropCause::missing], 4);
  EXPECT_EQ(drops[DropCause::superseded], 2);
  EXPECT_EQ(drops[DropCause::damaged], 1);
  EXPECT_EQ(supervisor.counts().frames + drops.total(), 18 - 7 + 1);
}

TEST_F(SupervisorTest, EachStepTakesATickAtMost) {
  camera.absent = "is not there";
  for (int i = 0; i < 50; ++i) {
    const std::int64_t before_ns = clock.mono_ns();
    supervisor.next();
    EXPECT_LE(clock.mono_ns() - before_ns, 100 * kMs);
  }
}

TEST(SupervisorThreads, FramesAreJudgedInAnotherThanTheyAreTakenIn) {
  ReplayClock clock;
  ScriptedCamera camera(clock);
  Supervisor supervisor(camera, clock, [](const CameraEvent&) {});
  std::thread other([&] {
    for (int i = 0; i < 1000; ++i) supervisor.judged("damaged JPEG");
  });
  for (int i = 0; i < 1000; ++i) {
    camera.frames({i});
    supervisor.next();
  }
  other.join();
  for (int i = 0; i < 20; ++i) {
    camera.frames({i});
    supervisor.next();
  }
  EXPECT_EQ(supervisor.state(), CameraState::stalled);
}

TEST(SupervisorInterrupt, EndsTheWaitForACamera) {
  SystemClock clock;
  ReplayClock unused;
  ScriptedCamera camera(unused);
  camera.absent = "is not there";
  SupervisorOptions options;
  options.reopen_min = options.tick = std::chrono::hours(1);
  Supervisor supervisor(
      camera, clock, [](const CameraEvent&) {}, options);
  EXPECT_EQ(supervisor.next().kind, Grab::Kind::timeout);
  std::thread other([&] { supervisor.interrupt(); });
  EXPECT_EQ(supervisor.next().kind, Grab::Kind::interrupted);
  other.join();
}

}  // namespace
}  // namespace bole
