#pragma once

#include <cstdint>
#include <span>

namespace bole {

/// CRC-32 (IEEE 802.3, as in zlib and PNG) of `bytes`, continuing from `seed`.
std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t seed = 0);

}  // namespace bole
