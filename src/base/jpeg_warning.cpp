#include "base/jpeg_warning.h"

#include <charconv>

namespace bole {

bool is_jpeg_padding(std::string_view warning) {
  constexpr std::string_view kBefore = "Corrupt JPEG data: ";
  constexpr std::string_view kAfter = " extraneous bytes before marker 0xd9";
  // Codes that were damaged may run out early, but then leave more.
  constexpr int kMostBytes = 64;
  if (!warning.starts_with(kBefore) || !warning.ends_with(kAfter)) return false;
  int bytes = 0;
  const auto [stop, error] = std::from_chars(
      warning.data() + kBefore.size(), warning.data() + warning.size() - kAfter.size(), bytes);
  return error == std::errc() && bytes <= kMostBytes;
}

}  // namespace bole
