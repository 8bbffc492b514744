#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace bole {

/// How a frame's bytes are laid out, named as Video4Linux and libcamera name them. Bayer: eight
/// bits a pixel, the name gives the first two pixels of the first two rows.
enum class PixelFormat : std::uint8_t {
  grey,
  yuyv,
  uyvy,
  nv12,
  rggb,
  grbg,
  gbrg,
  bggr,
  rgb24,
  bgr24,
  mjpeg,
};

/// The format's name in lower case, as in file endings and messages: "yuyv".
std::string_view name(PixelFormat format);

/// The format of that name; nullopt for any other.
std::optional<PixelFormat> pixel_format_from_name(std::string_view name);

struct ImageSize {
  int width = 0;   // pixels
  int height = 0;  // pixels
  friend bool operator==(const ImageSize&, const ImageSize&) = default;
};

/// "640 x 480".
std::string shown(ImageSize size);

/// One plane of an image in memory that somebody else owns.
struct Plane {
  std::span<const std::byte> bytes;
  int stride = 0;  // bytes from a row to the next
};

/// An image as the camera delivered it, in memory that somebody else owns. NV12 has two planes
/// (luma; interleaved chroma), MJPEG one whose stride is 0, all others one.
struct ImageView {
  PixelFormat format = PixelFormat::grey;
  ImageSize size;
  std::array<Plane, 2> planes;
};

/// Bytes of one tightly packed row of the first plane; 0 for MJPEG.
int packed_row_bytes(PixelFormat format, int width);

/// Bytes of a whole tightly packed frame, all planes; 0 for MJPEG, whose frames vary.
std::size_t packed_frame_bytes(PixelFormat format, ImageSize size);

/// A view of one tightly packed frame at the start of `bytes`; nullopt when they are too few or
/// the size is impossible for the format (odd width in YUYV, odd size in NV12 or Bayer).
std::optional<ImageView> view_packed(PixelFormat format, ImageSize size,
                                     std::span<const std::byte> bytes);

}  // namespace bole
