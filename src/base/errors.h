#pragma once

#include <stdexcept>
#include <string>

namespace bole {

/// errno in words.
std::string error_text(int error);

/// What a user has to mend before the program can start: a file, a key or an option that is
/// damaged, missing or does not fit. Programs print what() as one line and exit with code 2.
class ConfigError : public std::runtime_error {
 public:
  /// `file`: the file (or option) at fault; `key`: the key, line or field in it, may be empty;
  /// `problem`: what is wrong; `remedy`: what would be right, may be empty.
  ConfigError(const std::string& file, const std::string& key, const std::string& problem,
              const std::string& remedy);
};

}  // namespace bole
