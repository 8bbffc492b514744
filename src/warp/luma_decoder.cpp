#include "warp/luma_decoder.h"

#include <string>

#include "warp/bad_frame.h"

namespace bole {

ImageView LumaDecoder::decode(std::span<const std::byte> jpeg, ImageSize size) {
  try {
    const ImageSize got = decoder_.read_header(jpeg).size;
    if (got != size) throw BadFrame(got, size);
    luma_.resize(packed_frame_bytes(PixelFormat::grey, size));
    decoder_.decode(PixelFormat::grey, luma_);
  } catch (const DamagedJpeg& damage) {
    throw BadFrame(std::string("damaged JPEG: ") + damage.what());
  }
  return {PixelFormat::grey, size, {Plane{luma_, size.width}, Plane{}}};
}

}  // namespace bole
