#pragma once

#include <string_view>

namespace bole {

/// Whether a picture of which libjpeg says only `warning` is whole all the same: it was decoded to
/// its last row, and a few bytes too many stand before its end marker, as cheap cameras leave them.
/// libjpeg keeps the first warning's words alone. None can have come after this one, since nothing
/// follows the end marker.
bool is_jpeg_padding(std::string_view warning);

}  // namespace bole
