#include "base/checksum.h"

#include <zlib.h>

namespace bole {

std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t seed) {
  // zlib takes a null pointer, which an empty span has, as the wish for its initial value.
  if (bytes.empty()) return seed;
  return static_cast<std::uint32_t>(
      ::crc32_z(seed, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace bole
