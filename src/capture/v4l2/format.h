#pragma once

#include <array>
#include <chrono>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/camera_settings.h"
#include "capture/v4l2/device.h"

namespace bole {

/// The pixel format that a fourcc names; nullopt for those we cannot read.
std::optional<PixelFormat> pixel_format_of(std::uint32_t fourcc);
/// "YUYV"; unprintable characters as dots.
std::string fourcc_text(std::uint32_t fourcc);

/// How frames lie in a driver's buffers.
struct V4l2Format {
  v4l2_buf_type type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  std::uint32_t fourcc = 0;
  PixelFormat pixels = PixelFormat::grey;
  ImageSize size;
  int memory_planes = 1;               ///< memory areas of a buffer; two for NV12M, else one
  std::array<int, 2> strides;          ///< bytes from row to row of each image plane
  std::chrono::nanoseconds period{0};  ///< 0: the driver does not say
};

/// Agrees with the driver on format, size and rate, and tells what it made of it. Of several
/// formats the one with the least work for us that reaches settings.frame_rate, else the fastest.
/// Throws CaptureError when there is none of settings.size.
V4l2Format negotiate_format(const V4l2Device& device, const CameraSettings& settings);

/// The formats of a device that we can read, as the driver lists them.
std::vector<std::uint32_t> list_formats(const V4l2Device& device, v4l2_buf_type type);

/// The filled part of each memory area of a buffer as an image; nullopt when it is too short.
std::optional<ImageView> view_buffer(const V4l2Format& format,
                                     std::span<const std::span<const std::byte>> areas);

}  // namespace bole
