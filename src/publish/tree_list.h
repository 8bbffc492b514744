#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "detect/tree.h"

namespace bole {

/// Where a list's frame came from; the numbers are those of tree_list_t.
enum class ListSource : std::int8_t { v4l2 = 0, libcamera = 1, replay = 2, fake = 3 };

/// The trees of one processed frame, before they are put on the wire. The members mean what those
/// of tree_list_t mean.
struct TreeList {
  std::int64_t utime = 0;            ///< capture time, UTC microseconds
  std::int64_t capture_mono_ns = 0;  ///< the same instant on CLOCK_MONOTONIC
  std::int64_t publish_mono_ns = 0;
  std::int64_t seq = 0;
  std::int64_t sensor_seq = 0;
  std::uint32_t config_crc = 0;
  ListSource source = ListSource::replay;
  bool degraded = false;
  std::string camera;           ///< at most kMostCameraBytes bytes
  std::span<const Tree> trees;  ///< in any order, any number
};

constexpr std::size_t kMostCameraBytes = 16;

}  // namespace bole
