#pragma once

#include <filesystem>
#include <string>

#include "warp/warp_table.h"

namespace bole {

/// Where tables that a program builds by itself are kept: $CACHE_DIRECTORY (systemd's), else
/// $XDG_CACHE_HOME/bole, else $HOME/.cache/bole; empty when none of them is set.
std::filesystem::path default_cache_directory();

struct CachedTable {
  WarpTable table;
  bool built = false;          ///< not found, or found unusable
  std::string trouble;         ///< why it could not be kept; empty: it is kept
  std::filesystem::path path;  ///< where it is kept
};

/// The camera's table from `cache_directory`; built and kept there when it is missing, damaged or
/// of another version. A folder that cannot be written to costs the next start its time, no more.
/// Throws ConfigError as build_warp_table does.
CachedTable load_or_build_warp_table(const Camera& camera,
                                     const std::filesystem::path& cache_directory);

}  // namespace bole
