#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

namespace bole {

/// A closed interval of allowed numbers.
struct Bounds {
  double low;
  double high;
};

/// One table of a TOML file, read key by key. Every reader names the file and the dotted key when
/// it throws ConfigError, and done() refuses keys that nobody asked for, so that a misspelt key is
/// never silently the default.
class TomlTable {
 public:
  /// `file` is only for messages; `prefix` is the dotted path of this table in it.
  TomlTable(const toml::table& table, std::string file, std::string prefix = "");

  /// The subtable `key`; an empty one when it is absent.
  TomlTable table(std::string_view key);
  bool has(std::string_view key) const;

  /// A finite number within `bounds`; `fallback` when the key is absent.
  double number(std::string_view key, double fallback, Bounds bounds);
  /// As above, the key must be there.
  double required_number(std::string_view key, Bounds bounds);
  int integer(std::string_view key, int fallback, Bounds bounds);
  int required_integer(std::string_view key, Bounds bounds);
  bool boolean(std::string_view key, bool fallback);
  std::string text(std::string_view key, std::string_view fallback);
  /// One of `choices`.
  std::string choice(std::string_view key, std::string_view fallback,
                     const std::vector<std::string>& choices);
  std::vector<std::string> texts(std::string_view key, const std::vector<std::string>& fallback);
  /// [low, high], both within `bounds` and low < high.
  Bounds interval(std::string_view key, Bounds fallback, Bounds bounds);

  /// Throws for the first key of this table that was not read.
  void done() const;
  /// Throws ConfigError for `key` of this table.
  [[noreturn]] void fail(std::string_view key, const std::string& problem,
                         const std::string& remedy) const;

 private:
  const toml::node* find(std::string_view key);
  std::string path(std::string_view key) const;

  toml::table table_;
  std::string file_;
  std::string prefix_;
  std::set<std::string, std::less<>> read_;
};

/// Throws ConfigError for a line of TOML with so many dots that the tables of a key in it might be
/// nested too deep for the stack of the parser, which recurses into them.
void refuse_deep_keys(std::string_view text, const std::string& file);

/// Parses `text` as TOML; a syntax error becomes ConfigError with line and column.
toml::table parse_toml(std::string_view text, const std::string& file);

}  // namespace bole
