// What the camera offers: pixel formats, the frame sizes of each, and the pictures it shows.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/files.h"

namespace hil {

/// How one V4L2 pixel format looks on USB (UVC 1.1 payload specifications).
struct PixelFormat {
  std::string_view fourcc;       // V4L2's name of it
  std::array<uint8_t, 16> guid;  // unused for MJPG
  unsigned bits_per_pixel;       // 0 for MJPG
  bool is_jpeg() const { return bits_per_pixel == 0; }
};

/// One size of one format, with the frames that the camera shows over and over.
struct FrameSize {
  unsigned width;
  unsigned height;
  uint32_t max_bytes;  // of the largest frame
  std::vector<std::byte> file;
  std::vector<std::span<const uint8_t>> frames;  // views into `file`
};

struct VideoFormat {
  const PixelFormat* pixel_format;
  std::vector<FrameSize> sizes;
};

/// Reads "FOURCC:WIDTHxHEIGHT:FILE" once for each mode; modes of one format are put together, in
/// the order of first mention. FILE holds whole frames one after another. Throws
/// std::runtime_error naming the argument that cannot be understood.
std::vector<VideoFormat> load_video_modes(std::span<const std::string> arguments);

}  // namespace hil
