#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "base/image.h"

namespace bole {

/// The pixel format that the file's name ends in ("frame.yuyv"); none: an image, or no frame.
std::optional<PixelFormat> raw_format(const std::filesystem::path& path);

/// True when a file of that name is taken for a frame: an image, or a raw one.
bool is_frame_name(const std::filesystem::path& path);

/// The frames in a folder, in the byte order of their names; `mask` (may be empty) is none. Throws
/// ConfigError when the folder cannot be listed or holds none.
std::vector<std::filesystem::path> frames_in(const std::filesystem::path& folder,
                                             const std::filesystem::path& mask);

}  // namespace bole
