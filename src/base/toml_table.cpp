#include "base/toml_table.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/errors.h"

namespace bole {
namespace {

std::string shown(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

std::string shown(Bounds bounds) {
  return "from " + shown(bounds.low) + " to " + shown(bounds.high);
}

std::string joined(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

bool inside(double value, Bounds bounds) {  // false for NaN
  return value >= bounds.low && value <= bounds.high;
}

}  // namespace

TomlTable::TomlTable(const toml::table& table, std::string file, std::string prefix)
    : table_(table), file_(std::move(file)), prefix_(std::move(prefix)) {}

const toml::node* TomlTable::find(std::string_view key) {
  read_.emplace(key);
  return table_.get(key);
}

std::string TomlTable::path(std::string_view key) const {
  return prefix_.empty() ? std::string(key) : prefix_ + "." + std::string(key);
}

void TomlTable::fail(std::string_view key, const std::string& problem,
                     const std::string& remedy) const {
  throw ConfigError(file_, path(key), problem, remedy);
}

TomlTable TomlTable::table(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return {toml::table{}, file_, path(key)};
  if (!node->is_table()) fail(key, "is not a table", "write [" + path(key) + "]");
  return {*node->as_table(), file_, path(key)};
}

bool TomlTable::has(std::string_view key) const { return table_.contains(key); }

double TomlTable::number(std::string_view key, double fallback, Bounds bounds) {
  return find(key) == nullptr ? fallback : required_number(key, bounds);
}

double TomlTable::required_number(std::string_view key, Bounds bounds) {
  const toml::node* node = find(key);
  if (node == nullptr) fail(key, "is missing", "give a number " + shown(bounds));
  const std::optional<double> value = node->is_number() ? node->value<double>() : std::nullopt;
  if (!value) fail(key, "is not a number", "give a number " + shown(bounds));
  if (!inside(*value, bounds)) {
    fail(key, "is " + shown(*value), "must be " + shown(bounds));
  }
  return *value;
}

int TomlTable::integer(std::string_view key, int fallback, Bounds bounds) {
  return find(key) == nullptr ? fallback : required_integer(key, bounds);
}

int TomlTable::required_integer(std::string_view key, Bounds bounds) {
  const double value = required_number(key, bounds);
  if (value != std::floor(value)) fail(key, "is " + shown(value), "must be a whole number");
  return static_cast<int>(value);
}

bool TomlTable::boolean(std::string_view key, bool fallback) {
  const toml::node* node = find(key);
  if (node == nullptr) return fallback;
  if (!node->is_boolean()) fail(key, "is not a truth value", "write true or false");
  return node->as_boolean()->get();
}

std::string TomlTable::text(std::string_view key, std::string_view fallback) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::string(fallback);
  if (!node->is_string()) fail(key, "is not a text", "write it in quotes");
  return node->as_string()->get();
}

std::string TomlTable::choice(std::string_view key, std::string_view fallback,
                              const std::vector<std::string>& choices) {
  std::string value = text(key, fallback);
  if (std::ranges::find(choices, value) == choices.end()) {
    fail(key, "is \"" + value + "\"", "must be one of: " + joined(choices));
  }
  return value;
}

std::vector<std::string> TomlTable::texts(std::string_view key,
                                          const std::vector<std::string>& fallback) {
  const toml::node* node = find(key);
  if (node == nullptr) return fallback;
  if (!node->is_array()) fail(key, "is not a list", "write [\"...\", \"...\"]");
  std::vector<std::string> values;
  for (const toml::node& element : *node->as_array()) {
    if (!element.is_string()) fail(key, "holds something that is not a text", "quote each element");
    values.push_back(element.as_string()->get());
  }
  return values;
}

Bounds TomlTable::interval(std::string_view key, Bounds fallback, Bounds bounds) {
  const toml::node* node = find(key);
  if (node == nullptr) return fallback;
  const toml::array* pair = node->as_array();
  const std::string remedy = "write [low, high], low below high, both " + shown(bounds);
  if (pair == nullptr || pair->size() != 2 || !pair->get(0)->is_number() ||
      !pair->get(1)->is_number()) {
    fail(key, "is not a pair of numbers", remedy);
  }
  const Bounds value{*pair->get(0)->value<double>(), *pair->get(1)->value<double>()};
  if (!inside(value.low, bounds) || !inside(value.high, bounds) || !(value.low < value.high)) {
    fail(key, "is [" + shown(value.low) + ", " + shown(value.high) + "]", remedy);
  }
  return value;
}

void TomlTable::done() const {
  for (const auto& [key, node] : table_) {
    if (!read_.contains(key.str())) {
      fail(key.str(), "is not a known key",
           read_.empty() ? "" : "known here: " + joined({read_.begin(), read_.end()}));
    }
  }
}

void refuse_deep_keys(std::string_view text, const std::string& file) {
  constexpr int kMostDots = 1000;  // tens of thousands are too many for the parser's stack
  int line = 1;
  int dots = 0;
  for (const char c : text) {
    dots += c == '.' ? 1 : 0;
    if (dots > kMostDots) {
      throw ConfigError(file, "line " + std::to_string(line),
                        "has more than " + std::to_string(kMostDots) + " dots",
                        "nest keys less deep, break a long list into lines");
    }
    if (c == '\n') {
      ++line;
      dots = 0;
    }
  }
}

toml::table parse_toml(std::string_view text, const std::string& file) {
  refuse_deep_keys(text, file);
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    throw ConfigError(file,
                      "line " + std::to_string(error.source().begin.line) + ", column " +
                          std::to_string(error.source().begin.column),
                      std::string(error.description()), "write valid TOML");
  }
}

}  // namespace bole
