#include "warp/table_cache.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include "base/errors.h"

namespace bole {
namespace {

std::string file_name(std::uint32_t digest) {
  std::array<char, 32> name{};
  const int length = std::snprintf(name.data(), name.size(), "warp-%08x.table", digest);
  return {name.data(), static_cast<std::size_t>(length)};
}

// Each change of a camera makes another table: the newest are enough.
void forget_old_tables(const std::filesystem::path& directory) {
  constexpr std::size_t kKept = 8;
  struct Stored {
    std::filesystem::file_time_type written;
    std::filesystem::path path;
  };
  std::vector<Stored> stored;
  std::error_code error;  // whatever is not to be read or removed stays
  std::filesystem::directory_iterator entry(directory, error);
  for (; entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename();
    if (!name.starts_with("warp-") || !name.ends_with(".table")) continue;
    stored.push_back({entry->last_write_time(error), entry->path()});
  }
  std::ranges::sort(stored, std::ranges::greater(), &Stored::written);
  const std::span<const Stored> old = std::span(stored).subspan(std::min(kKept, stored.size()));
  for (const Stored& table : old) std::filesystem::remove(table.path, error);
}

std::optional<WarpTable> load(const std::filesystem::path& path, std::uint32_t digest) {
  try {
    return WarpTable::load(path, digest);
  } catch (const ConfigError&) {
    return std::nullopt;  // built anew; what was wrong with it does not matter
  }
}

}  // namespace

std::filesystem::path default_cache_directory() {
  // systemd may list several directories; the first is ours.
  if (const char* const list = std::getenv("CACHE_DIRECTORY")) {
    const std::string first(list);
    return first.substr(0, first.find(':'));
  }
  if (const char* const cache = std::getenv("XDG_CACHE_HOME")) {
    return std::filesystem::path(cache) / "bole";
  }
  if (const char* const home = std::getenv("HOME")) {
    return std::filesystem::path(home) / ".cache" / "bole";
  }
  return {};
}

CachedTable load_or_build_warp_table(const Camera& camera,
                                     const std::filesystem::path& cache_directory) {
  if (cache_directory.empty()) {
    return {build_warp_table(camera), true, "no cache directory is set", ""};
  }
  const std::filesystem::path path = cache_directory / file_name(camera.digest);
  if (std::optional<WarpTable> found = load(path, camera.digest)) {
    return {std::move(*found), false, "", path};
  }
  CachedTable result{build_warp_table(camera), true, "", path};
  try {
    result.table.store(path);
    forget_old_tables(cache_directory);
  } catch (const ConfigError& error) {
    result.trouble = error.what();
  }
  return result;
}

}  // namespace bole
