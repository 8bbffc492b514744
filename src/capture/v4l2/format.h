#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "capture/buffer_layout.h"
#include "capture/camera_settings.h"
#include "capture/v4l2/device.h"

namespace bole {

/// The pixel format that a fourcc names; nullopt for those we cannot read.
std::optional<PixelFormat> pixel_format_of(std::uint32_t fourcc);
/// "YUYV"; unprintable characters as dots.
std::string fourcc_text(std::uint32_t fourcc);

/// What a driver and we have agreed on.
struct V4l2Format {
  v4l2_buf_type type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  std::uint32_t fourcc = 0;
  BufferLayout layout;
  std::chrono::nanoseconds period{0};  ///< 0: the driver does not say
};

/// Agrees with the driver on format, size and rate, and tells what it made of it. Of several
/// formats the one with the least work for us that reaches settings.frame_rate, else the fastest.
/// Throws CaptureError when there is none of settings.size.
V4l2Format negotiate_format(const V4l2Device& device, const CameraSettings& settings);

/// The formats of a device that we can read, as the driver lists them.
std::vector<std::uint32_t> list_formats(const V4l2Device& device, v4l2_buf_type type);

}  // namespace bole
