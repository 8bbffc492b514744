#pragma once

#include <limits>
#include <string>
#include <vector>

#include "bole/status_t.hpp"
#include "publish/tree_list.h"

namespace bole {

/// The lists and statuses whose bytes lie in tests/golden/publish. Numbers are exact in binary.
inline std::vector<Tree> sample_trees(int count) {
  std::vector<Tree> trees;
  for (int k = 0; k < count; ++k) {
    const float f = static_cast<float>(k);
    trees.push_back({k, -3 + f / 8, 1 + f / 4, 0.25F + f / 64, 1 - f / 64, 0.015625F, 0.125F,
                     0.0625F, -0.5F + f / 128, 0.25F});
  }
  return trees;
}

inline TreeList sample_list(const std::vector<Tree>& trees) {
  TreeList list;
  list.utime = 1'700'000'000'123'456;
  list.capture_mono_ns = 1'234'567'890'123;
  list.publish_mono_ns = 1'234'570'000'000;
  list.seq = 41;
  list.sensor_seq = 43;
  list.config_crc = 0xDEADBEEF;
  list.source = ListSource::v4l2;
  list.camera = "front";
  list.trees = trees;
  return list;
}

/// Every integer at its end, floats at theirs.
inline TreeList extreme_list(std::vector<Tree>& trees) {
  using Float = std::numeric_limits<float>;
  using Long = std::numeric_limits<std::int64_t>;
  trees = {{std::numeric_limits<std::int32_t>::min(), Float::lowest(), Float::max(), Float::min(),
            Float::denorm_min(), -0.0F, Float::epsilon(), 1, -1, 0}};
  TreeList list;
  list.utime = Long::min();
  list.capture_mono_ns = Long::max();
  list.publish_mono_ns = -1;
  list.seq = 0;
  list.sensor_seq = Long::max();
  list.config_crc = 0xFFFFFFFF;
  list.source = ListSource::replay;
  list.degraded = true;
  list.camera = std::string(kMostCameraBytes, 'c');
  list.trees = trees;
  return list;
}

inline status_t sample_status() {
  status_t status{};
  status.utime = 1'700'000'001'000'000;
  status.mono_ns = 1'235'000'000'000;
  status.uptime_ns = 5'000'000'000;
  status.version = "0.1.0";
  status.camera = "front";
  status.source = "v4l2:/dev/video0 yuyv 1280x960 30 Hz";
  status.state = status_t::STATE_NO_CAMERA;
  status.state_reason = "unplugged";
  status.degraded = 1;
  status.degraded_reason = "dark";
  status.frames = 150;
  status.lists = 148;
  status.frame_rate = 30;
  status.list_rate = 29.5F;
  status.latency_p50_ms = 2.5F;
  status.latency_p99_ms = 4.75F;
  status.latency_max_ms = 9;
  status.drops = {{"overwritten", 2}, {"bad_frame", 0}};
  status.camera_events = {{"losses", 3}};
  bus_t bus{};
  bus.name = "lcm";
  bus.healthy = 1;
  bus.published = 147;
  bus.overwritten = 1;
  bus.handover_p50_us = 31.5F;
  bus.handover_p99_us = 120;
  bus.handover_max_us = 250;
  for (int k = 0; k < bus_t::HANDOVER_BINS; ++k) bus.handover_histogram[k] = k;
  status.buses = {bus};
  status.last_error = "no multicast route";
  return status;
}

}  // namespace bole
