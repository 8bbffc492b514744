#include "capture/v4l2/stamp.h"

#include <cstdlib>

namespace bole {

V4l2Stamp read_stamp(const v4l2_buffer& buffer, std::int64_t mono_ns, std::int64_t utc_ns) {
  const std::int64_t ns =
      buffer.timestamp.tv_sec * std::int64_t{1'000'000'000} + buffer.timestamp.tv_usec * 1000;
  const bool says_monotonic =
      (buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  const bool realtime = !says_monotonic && std::abs(ns - utc_ns) < std::abs(ns - mono_ns);
  const std::int64_t now_ns = realtime ? utc_ns : mono_ns;
  V4l2Stamp read;
  read.stamp.clock = realtime ? StampClock::realtime : StampClock::monotonic;
  read.corrected = ns > now_ns || ns == 0;
  read.stamp.ns = read.corrected ? now_ns : ns;
  return read;
}

}  // namespace bole
