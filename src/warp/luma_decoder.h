#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/image.h"
#include "base/jpeg_decoder.h"

namespace bole {

/// Decodes JPEG frames to their luma plane: no chroma is transformed and no colour converted.
class LumaDecoder {
 public:
  /// The luma plane of `jpeg`, which must be of `size`, as a grey image that stays until the next
  /// call. Throws BadFrame when it is damaged or of another size.
  ImageView decode(std::span<const std::byte> jpeg, ImageSize size);

 private:
  JpegDecoder decoder_;
  std::vector<std::byte> luma_;
};

}  // namespace bole
