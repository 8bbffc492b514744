#include "base/image.h"

#include <algorithm>

namespace bole {
namespace {

constexpr std::array<std::string_view, 11> kNames = {
    "grey", "yuyv", "uyvy", "nv12", "rggb", "grbg", "gbrg", "bggr", "rgb24", "bgr24", "mjpeg"};

bool needs_even_width(PixelFormat format) {
  return format != PixelFormat::grey && format != PixelFormat::rgb24 &&
         format != PixelFormat::bgr24 && format != PixelFormat::mjpeg;
}

bool needs_even_height(PixelFormat format) {
  return needs_even_width(format) && format != PixelFormat::yuyv && format != PixelFormat::uyvy;
}

}  // namespace

std::string_view name(PixelFormat format) { return kNames.at(static_cast<std::size_t>(format)); }

std::optional<PixelFormat> pixel_format_from_name(std::string_view name) {
  const auto* const found = std::ranges::find(kNames, name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<PixelFormat>(found - kNames.begin());
}

std::string shown(ImageSize size) {
  return std::to_string(size.width) + " x " + std::to_string(size.height);
}

int packed_row_bytes(PixelFormat format, int width) {
  switch (format) {
    case PixelFormat::yuyv:
    case PixelFormat::uyvy:
      return 2 * width;
    case PixelFormat::rgb24:
    case PixelFormat::bgr24:
      return 3 * width;
    case PixelFormat::mjpeg:
      return 0;
    default:
      return width;
  }
}

std::size_t packed_frame_bytes(PixelFormat format, ImageSize size) {
  const auto luma = static_cast<std::size_t>(packed_row_bytes(format, size.width)) *
                    static_cast<std::size_t>(size.height);
  return format == PixelFormat::nv12 ? luma + luma / 2 : luma;
}

std::optional<ImageView> view_packed(PixelFormat format, ImageSize size,
                                     std::span<const std::byte> bytes) {
  if (format == PixelFormat::mjpeg) {
    if (bytes.empty()) return std::nullopt;
    return ImageView{format, size, {Plane{bytes, 0}, Plane{}}};
  }
  if (size.width <= 0 || size.height <= 0 || (needs_even_width(format) && size.width % 2 != 0) ||
      (needs_even_height(format) && size.height % 2 != 0) ||
      bytes.size() < packed_frame_bytes(format, size)) {
    return std::nullopt;
  }
  const int stride = packed_row_bytes(format, size.width);
  const auto first = static_cast<std::size_t>(stride) * static_cast<std::size_t>(size.height);
  ImageView view{format, size, {Plane{bytes.first(first), stride}, Plane{}}};
  if (format == PixelFormat::nv12) view.planes[1] = {bytes.subspan(first, first / 2), stride};
  return view;
}

}  // namespace bole
