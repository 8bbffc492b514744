#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/image.h"

namespace bole {

/// Reads a mask: a PNG of any kind, taken as grey, of exactly `size`. Row by row, 0 = never look
/// here. Throws ConfigError when it is missing, damaged, of another size or zero everywhere.
std::vector<std::uint8_t> read_mask(const std::filesystem::path& path, ImageSize size);

}  // namespace bole
