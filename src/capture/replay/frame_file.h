#pragma once

#include <filesystem>

#include "capture/replay/image_file.h"

namespace bole {

/// Reads the files that may be frames of one camera: images, and raw frames, which their name's
/// ending tells apart and whose size the calibration gives.
class FrameReader {
 public:
  /// `size`: what the calibration holds for; zero: images of any size, and no raw frames.
  explicit FrameReader(ImageSize size) : size_(size), images_(size) {}

  /// Throws UnreadableFrame when the file is missing, damaged or not of that size.
  void read(const std::filesystem::path& path, FrameSlot& slot);

 private:
  void read_raw(const std::filesystem::path& path, PixelFormat format, FrameSlot& slot) const;

  ImageSize size_;
  ImageReader images_;
};

}  // namespace bole
