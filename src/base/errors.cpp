#include "base/errors.h"

#include <algorithm>
#include <cctype>
#include <system_error>

namespace bole {
namespace {

// Names and values may come from hostile files: whatever they hold, the message stays one line.
std::string one_line(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
  return text;
}

std::string message(const std::string& file, const std::string& key, const std::string& problem,
                    const std::string& remedy) {
  std::string text = file;
  if (!key.empty()) text += (text.empty() ? "" : ": ") + key;
  text += (text.empty() ? "" : ": ") + problem;
  if (!remedy.empty()) text += "; " + remedy;
  return one_line(std::move(text));
}

}  // namespace

std::string error_text(int error) { return std::generic_category().message(error); }

ConfigError::ConfigError(const std::string& file, const std::string& key,
                         const std::string& problem, const std::string& remedy)
    : std::runtime_error(message(file, key, problem, remedy)) {}

}  // namespace bole
