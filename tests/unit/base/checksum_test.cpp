#include "base/checksum.h"

#include <gtest/gtest.h>

#include <string_view>

namespace bole {
namespace {

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text));
}

TEST(Crc32, IsTheOneOfZlibAndPng) { EXPECT_EQ(crc32(bytes_of("123456789")), 0xcbf43926U); }

TEST(Crc32, ContinuesFromASeed) {
  EXPECT_EQ(crc32(bytes_of("6789"), crc32(bytes_of("12345"))), 0xcbf43926U);
}

TEST(Crc32, NothingChangesNothing) { EXPECT_EQ(crc32({}, 0xcbf43926U), 0xcbf43926U); }

}  // namespace
}  // namespace bole
