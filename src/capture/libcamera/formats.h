#pragma once

#include <libcamera/pixel_format.h>

#include <array>

#include <libcamera/formats.h>

#include "base/image.h"

namespace bole {

struct LibcameraFormat {
  libcamera::PixelFormat theirs;
  PixelFormat ours;
};

/// The formats that can be read, the least work for us first. libcamera names RGB formats by the
/// bits of a little-endian word: its BGR888 has red in the first byte.
inline const std::array<LibcameraFormat, 11> kLibcameraFormats = {{
    {libcamera::formats::NV12, PixelFormat::nv12},
    {libcamera::formats::R8, PixelFormat::grey},
    {libcamera::formats::YUYV, PixelFormat::yuyv},
    {libcamera::formats::UYVY, PixelFormat::uyvy},
    {libcamera::formats::SRGGB8, PixelFormat::rggb},
    {libcamera::formats::SGRBG8, PixelFormat::grbg},
    {libcamera::formats::SGBRG8, PixelFormat::gbrg},
    {libcamera::formats::SBGGR8, PixelFormat::bggr},
    {libcamera::formats::BGR888, PixelFormat::rgb24},
    {libcamera::formats::RGB888, PixelFormat::bgr24},
    {libcamera::formats::MJPEG, PixelFormat::mjpeg},
}};

}  // namespace bole
