#pragma once

#include <span>

#include "capture/frame_pool.h"

namespace bole {

/// True when `file` begins as every PNG file does.
bool is_png(std::span<const std::byte> file);

/// Decodes a PNG image as grey, where it is grey, or bgr24. Throws UnreadableFrame when it is
/// damaged, truncated, or not of the size `wanted` (zero: any).
void decode_png(std::span<const std::byte> file, ImageSize wanted, FrameSlot& slot);

}  // namespace bole
