#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace bole {

/// Reads timestamps.csv: lines `file,utime_us` (UTC microseconds up to the year 2100), the first of
/// which may be that heading. Empty lines do not count. Throws ConfigError naming the line.
std::map<std::string, std::int64_t> read_timestamps(const std::filesystem::path& path);

}  // namespace bole
