#pragma once

#include <cstdint>

#include "base/clock.h"
#include "capture/frame.h"

namespace bole {

/// When a frame was taken, on both clocks of a message.
struct FrameTime {
  std::int64_t utc_us = 0;
  std::int64_t mono_ns = 0;
  /// For differences only: what time passed before the camera. Of a replay as it was recorded,
  /// whatever its pace; else mono_ns.
  std::int64_t scene_ns = 0;
};

/// When a frame was taken, from the stamp of its driver's clock. The other clock's reading is
/// mapped anew for every frame, from how the two stand now, so that a step of UTC concerns only the
/// frames in flight.
FrameTime frame_time(const FrameStamp& stamp, const Clock& clock);

}  // namespace bole
