#include "service/telemetry.h"

#include <gtest/gtest.h>

#include "base/clock.h"

namespace bole {
namespace {

std::int64_t count_of(const std::vector<counter_t>& drops, const std::string& name) {
  for (const counter_t& drop : drops) {
    if (drop.name == name) return drop.count;
  }
  return -1;
}

TEST(Telemetry, APlannerCanTellNoCameraFromStreaming) {
  Telemetry telemetry("1.0", "front");
  EXPECT_EQ(telemetry.status(0, false).state, status_t::STATE_STARTING);
  telemetry.capture_event({CameraState::streaming, "cam 640x480", false});
  status_t status = telemetry.status(0, false);
  EXPECT_EQ(status.state, status_t::STATE_STREAMING);
  EXPECT_EQ(status.source, "cam 640x480");
  EXPECT_EQ(status.state_reason, "");
  telemetry.capture_event({CameraState::no_camera, "unplugged", false});
  status = telemetry.status(0, false);
  EXPECT_EQ(status.state, status_t::STATE_NO_CAMERA);
  EXPECT_EQ(status.state_reason, "unplugged");
  EXPECT_EQ(status.last_error, "unplugged");
  EXPECT_EQ(status.source, "cam 640x480");
}

TEST(Telemetry, APlannerCanTellCannotSeeFromNoTrees) {
  Telemetry telemetry("1.0", "front");
  telemetry.capture_event({CameraState::streaming, "cam 640x480", false});
  telemetry.vision("dark");
  EXPECT_EQ(telemetry.status(0, false).degraded, 1);
  EXPECT_EQ(telemetry.status(0, false).degraded_reason, "dark");
  telemetry.vision("");
  EXPECT_EQ(telemetry.status(0, false).degraded, 0);
}

TEST(Telemetry, WhatFramesShowedGoesWithTheCamera) {
  Telemetry telemetry("1.0", "front");
  const auto forgotten = [&] {
    const status_t status = telemetry.status(0, false);
    return status.degraded == 0 && status.degraded_reason.empty() && status.latency_p50_ms == 0 &&
           status.latency_p99_ms == 0 && status.latency_max_ms == 0;
  };
  const auto see_badly = [&] {
    telemetry.vision("dark");
    telemetry.processed(5'000'000, 0);
  };
  telemetry.capture_event({CameraState::streaming, "cam 640x480", false});
  see_badly();
  EXPECT_FALSE(forgotten());
  telemetry.capture_event({CameraState::no_camera, "unplugged", false});
  EXPECT_TRUE(forgotten());
  see_badly();  // the last frame was still worked on
  EXPECT_TRUE(forgotten());
  telemetry.capture_event({CameraState::streaming, "cam 640x480", false});
  EXPECT_TRUE(forgotten()) << "until a frame comes";
  see_badly();
  EXPECT_FALSE(forgotten());
}

TEST(Telemetry, DropsAreToldByCause) {
  Telemetry telemetry("1.0", "front");
  CaptureCounts counts;
  counts.frames = 10;
  counts.drops[DropCause::superseded] = 2;
  counts.drops[DropCause::missing] = 3;
  telemetry.capture_counts(counts);
  telemetry.overwritten();
  telemetry.unusable("x.png", "is cut short");
  const status_t status = telemetry.status(0, false);
  EXPECT_EQ(status.frames, 10);
  EXPECT_EQ(count_of(status.drops, "superseded"), 2);
  EXPECT_EQ(count_of(status.drops, "missing"), 3);
  EXPECT_EQ(count_of(status.drops, "overwritten"), 1);
  EXPECT_EQ(count_of(status.drops, "unusable"), 1);
  EXPECT_EQ(status.last_error, "x.png: is cut short");
}

TEST(Telemetry, WhatBefellTheCameraIsCounted) {
  Telemetry telemetry("1.0", "front");
  CaptureCounts counts;
  counts.losses = 1;
  counts.stalls = 2;
  counts.restarts = 3;
  counts.failed_opens = 4;
  counts.settings_refused = 5;
  counts.stamps_corrected = 6;
  telemetry.capture_counts(counts);
  const std::vector<counter_t> events = telemetry.status(0, false).camera_events;
  EXPECT_EQ(count_of(events, "losses"), 1);
  EXPECT_EQ(count_of(events, "stalls"), 2);
  EXPECT_EQ(count_of(events, "restarts"), 3);
  EXPECT_EQ(count_of(events, "failed_opens"), 4);
  EXPECT_EQ(count_of(events, "settings_refused"), 5);
  EXPECT_EQ(count_of(events, "stamps_corrected"), 6);
}

TEST(Telemetry, RatesAreOverTheTimeSinceTheLastStatus) {
  Telemetry telemetry("1.0", "front");
  const std::int64_t now_ns = SystemClock().mono_ns() + 1'000'000'000;
  telemetry.status(now_ns, false);
  CaptureCounts counts;
  counts.frames = 20;
  telemetry.capture_counts(counts);
  for (int k = 0; k < 10; ++k) telemetry.processed(1'000'000, 0);
  const status_t status = telemetry.status(now_ns + 2'000'000'000, false);
  EXPECT_FLOAT_EQ(status.frame_rate, 10);
  EXPECT_FLOAT_EQ(status.list_rate, 5);
  telemetry.processed(1'000'000, 0);
  EXPECT_FLOAT_EQ(telemetry.status(now_ns + 2'100'000'000, false).list_rate, 5) << "too soon";
  EXPECT_FLOAT_EQ(telemetry.status(now_ns + 3'000'000'000, false).list_rate, 1);
  EXPECT_FLOAT_EQ(telemetry.status(now_ns + 4'000'000'000, false).list_rate, 0);
}

TEST(Telemetry, LatencyIsThatOfTheLastLists) {
  Telemetry telemetry("1.0", "front");
  telemetry.capture_event({CameraState::streaming, "cam 640x480", false});
  for (int k = 0; k < 1000; ++k) telemetry.processed(90'000'000, 0);
  for (int k = 0; k < 512; ++k) telemetry.processed(k * 10'000, 0);
  const status_t status = telemetry.status(0, false);
  EXPECT_NEAR(status.latency_p50_ms, 2.56F, 0.02F);
  EXPECT_NEAR(status.latency_p99_ms, 5.07F, 0.02F);
  EXPECT_FLOAT_EQ(status.latency_max_ms, 5.11F);
  EXPECT_NEAR(static_cast<double>(telemetry.summary().latency_max_ns), 9e7, 1);
}

}  // namespace
}  // namespace bole
