#include <vector>

#include "base/jpeg_decoder.h"
#include "fuzz/fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr int kLargest = 512;  // as the sizes that frames may have bound it
  thread_local bole::JpegDecoder decoder;
  try {
    const auto [picture, grey] = decoder.read_header(std::as_bytes(std::span(data, size)));
    if (picture.width > kLargest || picture.height > kLargest) return 0;
    const auto format = grey ? bole::PixelFormat::grey : bole::PixelFormat::bgr24;
    std::vector<std::byte> pixels(bole::packed_frame_bytes(format, picture));
    decoder.decode(format, pixels);
  } catch (const bole::DamagedJpeg&) {
    return 0;
  }
  return 0;
}
