#include "capture/replay/jpeg.h"

#include <turbojpeg.h>

#include <memory>
#include <string>

#include "base/jpeg_warning.h"
#include "capture/replay/image_file.h"

namespace bole {
namespace {

struct CloseDecoder {
  void operator()(void* handle) const { ::tjDestroy(handle); }
};
using Decoder = std::unique_ptr<void, CloseDecoder>;

[[noreturn]] void fail(const Decoder& decoder) {
  throw UnreadableFrame(std::string("is a damaged JPEG image: ") + ::tjGetErrorStr2(decoder.get()));
}

}  // namespace

bool is_jpeg(std::span<const std::byte> file) {
  return file.size() > 3 && file[0] == std::byte{0xff} && file[1] == std::byte{0xd8} &&
         file[2] == std::byte{0xff};
}

void decode_jpeg(std::span<const std::byte> file, ImageSize wanted, FrameSlot& slot) {
  thread_local const Decoder decoder(::tjInitDecompress());
  if (!decoder) throw UnreadableFrame("cannot be decoded: out of memory");
  const auto* bytes = reinterpret_cast<const unsigned char*>(file.data());
  const auto size = static_cast<unsigned long>(file.size());
  int subsampling = 0;
  int colourspace = 0;
  if (::tjDecompressHeader3(decoder.get(), bytes, size, &slot.size.width, &slot.size.height,
                            &subsampling, &colourspace) != 0) {
    fail(decoder);
  }
  check_frame_size(slot.size, wanted);
  const bool grey = colourspace == TJCS_GRAY;
  slot.format = grey ? PixelFormat::grey : PixelFormat::bgr24;
  slot.bytes.resize(packed_frame_bytes(slot.format, slot.size));
  // A warning counts as an error, but for one: what a truncated file lacks would come out as grey.
  if (::tjDecompress2(decoder.get(), bytes, size,
                      reinterpret_cast<unsigned char*>(slot.bytes.data()), slot.size.width, 0,
                      slot.size.height, grey ? TJPF_GRAY : TJPF_BGR, TJFLAG_LIMITSCANS) != 0 &&
      !(::tjGetErrorCode(decoder.get()) == TJERR_WARNING &&
        is_jpeg_padding(::tjGetErrorStr2(decoder.get())))) {
    fail(decoder);
  }
}

}  // namespace bole
