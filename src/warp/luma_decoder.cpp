#include "warp/luma_decoder.h"

#include <turbojpeg.h>

#include <new>
#include <string>

#include "base/jpeg_warning.h"
#include "warp/bad_frame.h"

namespace bole {

LumaDecoder::LumaDecoder() : handle_(tjInitDecompress()) {
  if (!handle_) throw std::bad_alloc();
}

LumaDecoder::~LumaDecoder() = default;

void LumaDecoder::CloseHandle::operator()(void* handle) const { tjDestroy(handle); }

ImageView LumaDecoder::decode(std::span<const std::byte> jpeg, ImageSize size) {
  const auto* const bytes = reinterpret_cast<const unsigned char*>(jpeg.data());
  int width = 0, height = 0, subsampling = 0, colour_space = 0;
  if (tjDecompressHeader3(handle_.get(), bytes, jpeg.size(), &width, &height, &subsampling,
                          &colour_space) != 0) {
    throw BadFrame(std::string("damaged JPEG: ") + tjGetErrorStr2(handle_.get()));
  }
  if (width != size.width || height != size.height) throw BadFrame({width, height}, size);
  luma_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  // libjpeg leaves chroma's transform out when grey is asked for. A warning is a damaged frame too,
  // but for one.
  if (tjDecompress2(handle_.get(), bytes, jpeg.size(), luma_.data(), width, width, height,
                    TJPF_GRAY, 0) != 0 &&
      !(tjGetErrorCode(handle_.get()) == TJERR_WARNING &&
        is_jpeg_padding(tjGetErrorStr2(handle_.get())))) {
    throw BadFrame(std::string("damaged JPEG: ") + tjGetErrorStr2(handle_.get()));
  }
  return {PixelFormat::grey, size, {Plane{std::as_bytes(std::span(luma_)), width}, Plane{}}};
}

}  // namespace bole
