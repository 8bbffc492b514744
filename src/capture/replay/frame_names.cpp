#include "capture/replay/frame_names.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>

#include "base/errors.h"
#include "capture/replay/names.h"

namespace bole {
namespace {

namespace fs = std::filesystem;

bool is_mask(const fs::path& path, const fs::path& mask) {
  if (mask.empty()) return false;
  std::error_code not_there;
  return path.filename() == mask.filename() || fs::equivalent(path, mask, not_there);
}

}  // namespace

std::optional<PixelFormat> raw_format(const fs::path& path) {
  return pixel_format_from_name(lower_ending(path));
}

bool is_frame_name(const fs::path& path) {
  constexpr std::array<std::string_view, 9> kEndings = {"png", "jpg", "jpeg", "bmp", "pgm",
                                                        "ppm", "tif", "tiff", "webp"};
  if (path.filename().string().starts_with('.')) return false;
  return raw_format(path) || std::ranges::find(kEndings, lower_ending(path)) != kEndings.end();
}

std::vector<fs::path> frames_in(const fs::path& folder, const fs::path& mask) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path& path = entry->path();
    std::error_code vanished;
    if (is_frame_name(path) && !is_mask(path, mask) && !fs::is_directory(path, vanished)) {
      files.push_back(path);
    }
  }
  if (error) {
    throw ConfigError(folder, "", "cannot be listed: " + error.message(),
                      "give a folder that may be read");
  }
  if (files.empty()) {
    throw ConfigError(
        folder, "", "holds no frame",
        "give a folder of images (png, jpg ...) or raw frames (yuyv, nv12, grey ...)");
  }
  std::ranges::sort(files, {}, [](const fs::path& path) { return path.filename().string(); });
  return files;
}

}  // namespace bole
