#pragma once

#include <span>

#include "capture/frame_pool.h"

namespace bole {

/// True when `file` begins as every JPEG file does.
bool is_jpeg(std::span<const std::byte> file);

/// Decodes a JPEG image as grey, where it has one component, or bgr24. Throws UnreadableFrame when
/// it is damaged, truncated, or not of the size `wanted` (zero: any).
void decode_jpeg(std::span<const std::byte> file, ImageSize wanted, FrameSlot& slot);

}  // namespace bole
