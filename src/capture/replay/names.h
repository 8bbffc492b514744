#pragma once

#include <filesystem>
#include <string>

namespace bole {

/// What stands behind the last dot of the file's name, in lower case (ASCII): "jpg".
inline std::string lower_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  if (!ending.empty()) ending.erase(0, 1);
  for (char& c : ending) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return ending;
}

}  // namespace bole
