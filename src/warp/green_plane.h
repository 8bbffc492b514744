#pragma once

#include <cstdint>
#include <vector>

#include "base/image.h"

namespace bole {

/// The green plane of a Bayer image: at red and blue places the mean, rounded, of the green
/// neighbours above, below, left and right (of those that exist). Written to `green`, row by row,
/// resized to the image's size.
void complete_bayer_green(const ImageView& image, std::vector<std::uint8_t>& green);

}  // namespace bole
