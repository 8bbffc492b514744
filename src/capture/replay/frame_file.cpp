#include "capture/replay/frame_file.h"

#include <string>

#include "capture/replay/frame_names.h"
#include "capture/replay/jpeg.h"

namespace bole {

void FrameReader::read(const std::filesystem::path& path, FrameSlot& slot) {
  if (const auto raw = raw_format(path)) {
    read_raw(path, *raw, slot);
  } else {
    images_.read(path, slot);
  }
}

void FrameReader::read_raw(const std::filesystem::path& path, PixelFormat format,
                           FrameSlot& slot) const {
  if (size_.width <= 0) throw UnreadableFrame("needs a calibration that gives its size");
  const std::size_t needed = packed_frame_bytes(format, size_);
  read_frame_file(path, slot.bytes);
  if (format == PixelFormat::mjpeg) {
    if (!is_jpeg(slot.bytes)) throw UnreadableFrame("does not begin as a JPEG does");
  } else if (slot.bytes.size() != needed || !view_packed(format, size_, slot.bytes)) {
    throw UnreadableFrame("has " + std::to_string(slot.bytes.size()) + " bytes; " +
                          std::to_string(needed) + " make a frame of the calibration's size");
  }
  slot.format = format;
  slot.size = size_;
}

}  // namespace bole
