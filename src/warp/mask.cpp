#include "warp/mask.h"

#include <png.h>

#include <algorithm>
#include <string>

#include "base/errors.h"
#include "base/files.h"

namespace bole {
namespace {

constexpr std::size_t kLargestFile = 64u << 20;

// libpng's simplified reader; frees what it holds when dropped.
class PngReader {
 public:
  PngReader(const std::vector<std::byte>& file, const std::filesystem::path& path) : path_(path) {
    image_.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&image_, file.data(), file.size()) == 0) fail();
    image_.format = PNG_FORMAT_GRAY;
  }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_image_free(&image_); }

  std::uint32_t width() const { return image_.width; }
  std::uint32_t height() const { return image_.height; }

  void read(std::vector<std::uint8_t>& pixels) {
    if (png_image_finish_read(&image_, nullptr, pixels.data(), 0, nullptr) == 0) fail();
  }

 private:
  [[noreturn]] void fail() const {
    throw ConfigError(path_, "", std::string("cannot be read as PNG: ") + image_.message,
                      "save the mask as an 8-bit grey PNG");
  }

  const std::filesystem::path& path_;
  png_image image_{};
};

std::string shown(std::int64_t width, std::int64_t height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

}  // namespace

std::vector<std::uint8_t> read_mask(const std::filesystem::path& path, ImageSize size) {
  const std::vector<std::byte> file = read_file(path, kLargestFile);
  PngReader reader(file, path);
  if (reader.width() != static_cast<std::uint32_t>(size.width) ||
      reader.height() != static_cast<std::uint32_t>(size.height)) {
    throw ConfigError(path, "", "is " + shown(reader.width(), reader.height()),
                      "the calibration's image is " + shown(size.width, size.height));
  }
  std::vector<std::uint8_t> mask(static_cast<std::size_t>(size.width) *
                                 static_cast<std::size_t>(size.height));
  reader.read(mask);
  if (std::ranges::all_of(mask, [](std::uint8_t value) { return value == 0; })) {
    throw ConfigError(path, "", "is zero everywhere, so that nothing would be seen",
                      "paint white what the camera may look at");
  }
  return mask;
}

}  // namespace bole
