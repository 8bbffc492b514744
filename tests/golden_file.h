#pragma once

#include <cstdlib>
#include <filesystem>
#include <span>
#include <vector>

#include "base/files.h"

namespace bole {

/// The bytes that tests/golden/NAME holds. With BOLE_WRITE_GOLDEN set in the environment, `now` is
/// written there first: for a change of format that is meant.
inline std::vector<std::byte> golden(const std::string& name, std::span<const std::byte> now) {
  const auto path = std::filesystem::path(BOLE_SOURCE_DIR) / "tests/golden" / name;
  if (std::getenv("BOLE_WRITE_GOLDEN") != nullptr) write_file_atomically(path, now);
  return read_file(path, std::size_t{1} << 24);
}

}  // namespace bole
