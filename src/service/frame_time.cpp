#include "service/frame_time.h"

namespace bole {

FrameTime frame_time(const FrameStamp& stamp, const Clock& clock) {
  if (stamp.clock == StampClock::replay) return {stamp.ns / 1000, stamp.mono_ns, stamp.ns};
  if (stamp.clock == StampClock::realtime) {
    const std::int64_t mono_ns = clock.mono_ns() - (clock.utc_us() * 1000 - stamp.ns);
    return {stamp.ns / 1000, mono_ns, mono_ns};
  }
  return {clock.utc_us() - (clock.mono_ns() - stamp.ns) / 1000, stamp.ns, stamp.ns};
}

}  // namespace bole
