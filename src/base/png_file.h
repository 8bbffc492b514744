#pragma once

#include <cstddef>
#include <vector>

#include "base/image.h"

namespace bole {

/// An image of the format rgb24 or bgr24 as a PNG file. Throws std::runtime_error when libpng
/// cannot, as for an empty image.
std::vector<std::byte> encode_png(const ImageView& image);

}  // namespace bole
