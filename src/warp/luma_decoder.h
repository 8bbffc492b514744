#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/image.h"

namespace bole {

/// Decodes JPEG frames to their luma plane: no chroma is transformed and no colour converted.
class LumaDecoder {
 public:
  LumaDecoder();
  ~LumaDecoder();
  LumaDecoder(const LumaDecoder&) = delete;
  LumaDecoder& operator=(const LumaDecoder&) = delete;

  /// The luma plane of `jpeg`, which must be of `size`, as a grey image that stays until the next
  /// call. Throws BadFrame when it is damaged or of another size.
  ImageView decode(std::span<const std::byte> jpeg, ImageSize size);

 private:
  struct CloseHandle {
    void operator()(void* handle) const;
  };
  std::unique_ptr<void, CloseHandle> handle_;
  std::vector<std::uint8_t> luma_;
};

}  // namespace bole
