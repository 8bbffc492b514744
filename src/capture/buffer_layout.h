#pragma once

#include <array>
#include <optional>
#include <span>

#include "base/image.h"

namespace bole {

/// How frames lie in a driver's buffers.
struct BufferLayout {
  PixelFormat pixels = PixelFormat::grey;
  ImageSize size;
  int memory_planes = 1;         ///< memory areas of a buffer; two where NV12 is split, else one
  std::array<int, 2> strides{};  ///< bytes from row to row of each image plane
};

/// The filled part of each memory area of a buffer as an image; nullopt when it is too short. The
/// last row need not be filled up to the stride.
std::optional<ImageView> view_buffer(const BufferLayout& layout,
                                     std::span<const std::span<const std::byte>> areas);

}  // namespace bole
