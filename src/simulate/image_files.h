#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "base/image.h"
#include "simulate/picture.h"

namespace bole::simulate {

/// The picture as a PNG file.
std::vector<std::byte> encode_png(const Picture& picture);

/// The picture as a JPEG file; `quality` from 1 to 100.
std::vector<std::byte> encode_jpeg(const Picture& picture, int quality);

/// The picture after a JPEG encoding and decoding.
Picture through_jpeg(const Picture& picture, int quality);

/// The bytes that a camera of that raw format would deliver, tightly packed: YUV with full-range
/// BT.601 coefficients as in JPEG, chroma averaged over the pixels that share it. MJPEG gives a
/// JPEG of quality 90. Throws std::invalid_argument when the size does not fit the format.
std::vector<std::byte> encode_raw(const Picture& picture, PixelFormat format);

}  // namespace bole::simulate
