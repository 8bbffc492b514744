#include "capture/replay/jpeg.h"

#include <string>

#include "base/jpeg_decoder.h"
#include "capture/replay/image_file.h"

namespace bole {

bool is_jpeg(std::span<const std::byte> file) {
  return file.size() > 3 && file[0] == std::byte{0xff} && file[1] == std::byte{0xd8} &&
         file[2] == std::byte{0xff};
}

void decode_jpeg(std::span<const std::byte> file, ImageSize wanted, FrameSlot& slot) {
  thread_local JpegDecoder decoder;
  try {
    const JpegDecoder::Header header = decoder.read_header(file);
    check_frame_size(header.size, wanted);
    slot.size = header.size;
    slot.format = header.grey ? PixelFormat::grey : PixelFormat::bgr24;
    slot.bytes.resize(packed_frame_bytes(slot.format, slot.size));
    decoder.decode(slot.format, slot.bytes);
  } catch (const DamagedJpeg& damage) {
    throw UnreadableFrame(std::string("is a damaged JPEG image: ") + damage.what());
  }
}

}  // namespace bole
