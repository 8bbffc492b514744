#include "capture/replay/timestamps.h"

#include <charconv>
#include <sstream>

#include "base/errors.h"
#include "base/files.h"
#include "capture/replay/media.h"

namespace bole {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{256} << 20;

// Throws ConfigError unless all of `text` is a whole number within the allowed span.
std::int64_t parse_utime(const std::string& text, const std::filesystem::path& path,
                         const std::string& where) {
  std::int64_t value = -1;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end || value < 0 || value > kMaxUtimeUs) {
    throw ConfigError(path, where, "\"" + text + "\" is not a time",
                      "give whole UTC microseconds from 0 to " + std::to_string(kMaxUtimeUs));
  }
  return value;
}

}  // namespace

std::map<std::string, std::int64_t> read_timestamps(const std::filesystem::path& path) {
  std::map<std::string, std::int64_t> stamps;
  std::istringstream text(read_text_file(path, kMaxBytes));
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || (number == 1 && line == "file,utime_us")) continue;
    const std::string where = "line " + std::to_string(number);
    const std::size_t comma = line.rfind(',');  // a name may hold a comma itself
    if (comma == std::string::npos || comma == 0) {
      throw ConfigError(path, where, "is not a pair", "write `file,utime_us`");
    }
    const std::string file = line.substr(0, comma);
    if (!stamps.emplace(file, parse_utime(line.substr(comma + 1), path, where)).second) {
      throw ConfigError(path, where, file + " has a time already", "give each file one line");
    }
  }
  return stamps;
}

}  // namespace bole
