#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "warp/warp_table.h"

namespace bole {

static_assert(std::endian::native == std::endian::little, "tables are stored little-endian");

/// The head of a stored table. After it come, each from a multiple of 64 bytes on: tiles, entries,
/// strays, seen pixels, seen rows of the columns.
struct WarpTableHead {
  static constexpr std::array<char, 8> kMagic{'b', 'o', 'l', 'e', 'w', 'a', 'r', 'p'};
  static constexpr std::uint32_t kVersion = 1;

  std::array<char, 8> magic = kMagic;
  std::uint32_t version = kVersion;
  std::uint32_t crc = 0;  ///< CRC-32 of everything behind this field
  std::uint64_t bytes = 0;
  std::uint32_t digest = 0;
  std::int32_t image_width = 0, image_height = 0;
  std::int32_t columns = 0, first_column = 0, width = 0, rows = 0;
  std::uint32_t strays = 0;
  double top_tangent = 0;
};
static_assert(sizeof(WarpTableHead) == 64 && sizeof(WarpTile) == 8 && sizeof(WarpStray) == 16);

/// What a table holds, before it is laid out in one piece.
struct WarpTableContent {
  WarpTableHead head;
  std::vector<WarpTile> tiles;
  std::vector<WarpEntry> entries;
  std::vector<WarpStray> strays;
  std::vector<std::uint8_t> seen;
  std::vector<SeenRows> columns;
};

/// The bytes of a table file, head completed.
std::vector<std::byte> warp_table_bytes(WarpTableContent content);

}  // namespace bole
