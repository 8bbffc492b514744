#pragma once

#include <filesystem>
#include <stdexcept>
#include <vector>

#include "capture/frame_pool.h"

namespace bole {

/// One file that is no usable frame; what() says why, without the file's name.
class UnreadableFrame : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// No image file larger than this is read, and none is decoded that has more pixels: a small
/// hostile file must not fill the memory.
inline constexpr std::size_t kMaxImageFileBytes = std::size_t{64} << 20;
inline constexpr std::int64_t kMaxImagePixels = std::int64_t{1} << 26;

/// Throws UnreadableFrame unless `size` is positive, within kMaxImagePixels and, where `wanted` is
/// not zero, equal to it.
void check_frame_size(ImageSize size, ImageSize wanted);

/// The bytes of a file that holds one frame. Throws UnreadableFrame.
void read_frame_file(const std::filesystem::path& path, std::vector<std::byte>& bytes);

/// Reads image files into slots as grey or bgr24, with their pixels as stored: an orientation
/// noted in the file is not applied, 16 bits become 8, transparency is dropped. JPEG and PNG
/// need no plug-in, every other format bole_replay_codecs.so.
class ImageReader {
 public:
  /// `wanted`: the size that images must have; zero: any.
  explicit ImageReader(ImageSize wanted = {}) : wanted_(wanted) {}

  /// Throws UnreadableFrame, also when the plug-in is needed and cannot be loaded.
  void read(const std::filesystem::path& path, FrameSlot& slot);

 private:
  ImageSize wanted_;
  std::vector<std::byte> file_;
};

}  // namespace bole
