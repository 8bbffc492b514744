#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "capture/frame_pool.h"

namespace bole {

/// A video file that is being read from its beginning on.
class VideoReader {
 public:
  virtual ~VideoReader() = default;
  virtual ImageSize size() const = 0;
  /// Frames a second by the file's own word; 0 when it gives none.
  virtual double rate_hz() const = 0;
  /// Steps to the next frame; false at the end.
  virtual bool step() = 0;
  /// Decodes the frame stepped to as bgr24 or grey. Returns what went wrong; empty: nothing.
  virtual std::string decode(FrameSlot& slot) = 0;
};

/// What only replay needs and the daemon does not link: decoders of images and videos. They live
/// in the plug-in bole_replay_codecs.so, errors cross its border as text.
class ReplayCodecs {
 public:
  virtual ~ReplayCodecs() = default;
  /// Decodes an image file as grey or bgr24. Returns what is wrong with it; empty: nothing.
  virtual std::string decode_image(std::span<const std::byte> file, FrameSlot& slot) const = 0;
  /// nullptr when the file is no video that can be read.
  virtual std::unique_ptr<VideoReader> open_video(const std::filesystem::path& path) const = 0;
};

/// The plug-in's decoders; loads it at the first call. Throws ConfigError when it cannot.
const ReplayCodecs& replay_codecs();

}  // namespace bole
