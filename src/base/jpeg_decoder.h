#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <stdexcept>

#include "base/image.h"

namespace bole {

/// A JPEG picture that cannot be decoded whole; what() says why in libjpeg's words.
class DamagedJpeg : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Decodes JPEG pictures. libjpeg makes something of damaged ones too, and warns: that is refused
/// here, since grey areas or torn rows would be taken for the scene. Allowed are a few bytes too
/// many before a marker: some cameras (Logitech's C270 and C910) leave them in nearly every frame,
/// and nothing of the picture is lost by them.
class JpegDecoder {
 public:
  JpegDecoder();
  ~JpegDecoder();
  JpegDecoder(const JpegDecoder&) = delete;
  JpegDecoder& operator=(const JpegDecoder&) = delete;

  struct Header {
    ImageSize size;
    bool grey = false;  ///< has no colours
  };

  /// The header of `jpeg`, whose bytes must stay until they are decoded. Throws DamagedJpeg.
  Header read_header(std::span<const std::byte> jpeg);

  /// The picture whose header was read last, from the top and tightly packed, as `format`: grey
  /// (its luma: chroma is not even transformed) or bgr24. `pixels` are packed_frame_bytes() of it.
  /// Throws DamagedJpeg.
  void decode(PixelFormat format, std::span<std::byte> pixels);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bole
