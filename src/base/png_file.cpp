#include "base/png_file.h"

#include <png.h>

#include <stdexcept>
#include <string>

namespace bole {

std::vector<std::byte> encode_png(const ImageView& image) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.size.width);
  png.height = static_cast<png_uint_32>(image.size.height);
  png.format = image.format == PixelFormat::bgr24 ? PNG_FORMAT_BGR : PNG_FORMAT_RGB;
  png.flags = PNG_IMAGE_FLAG_FAST;
  std::vector<std::byte> file(PNG_IMAGE_PNG_SIZE_MAX(png));
  png_alloc_size_t bytes = file.size();
  const Plane& pixels = image.planes[0];
  if (png_image_write_to_memory(&png, file.data(), &bytes, 0, pixels.bytes.data(), pixels.stride,
                                nullptr) == 0) {
    throw std::runtime_error(std::string("cannot be written as PNG: ") + png.message);
  }
  file.resize(bytes);
  return file;
}

}  // namespace bole
