#include "service/frame_time.h"

namespace bole {

FrameTime frame_time(const FrameStamp& stamp, const Clock& clock) {
  switch (stamp.clock) {
    case StampClock::replay:
      return {stamp.ns / 1000, stamp.mono_ns};
    case StampClock::realtime:
      return {stamp.ns / 1000, clock.mono_ns() - (clock.utc_us() * 1000 - stamp.ns)};
    case StampClock::monotonic:
      break;
  }
  return {clock.utc_us() - (clock.mono_ns() - stamp.ns) / 1000, stamp.ns};
}

}  // namespace bole
