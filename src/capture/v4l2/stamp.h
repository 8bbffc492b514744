#pragma once

#include <linux/videodev2.h>

#include <cstdint>

#include "capture/frame.h"

namespace bole {

/// The stamp of a buffer as this driver gives them, and whether it had to be corrected.
struct V4l2Stamp {
  FrameStamp stamp;
  bool corrected = false;
};

/// Reads a buffer's stamp by its flags. Where the driver does not say which clock it reads, it is
/// the one that is nearer. A stamp that lies in the future, or is none (0), becomes now: `mono_ns`
/// and `utc_ns` are the clocks' readings when the buffer was fetched.
V4l2Stamp read_stamp(const v4l2_buffer& buffer, std::int64_t mono_ns, std::int64_t utc_ns);

}  // namespace bole
