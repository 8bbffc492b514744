#include "capture/replay/faults.h"

#include <array>
#include <string_view>

#include "base/errors.h"
#include "base/files.h"
#include "base/toml_table.h"

namespace bole {
namespace {

constexpr std::size_t kMaxScriptBytes = 1 << 20;
constexpr double kMaxSeconds = 1e6;
constexpr double kMaxFrames = 1e9;
constexpr std::array<std::string_view, 7> kKinds = {"drop",   "duplicate", "stall",     "corrupt",
                                                    "unplug", "late",      "clock_step"};

Fault::Kind kind_of(TomlTable& table) {
  const std::vector<std::string> choices(kKinds.begin(), kKinds.end());
  if (!table.has("kind"))
    table.fail("kind", "is missing", "must be one of drop, stall, unplug ...");
  const std::string kind = table.choice("kind", "", choices);
  for (std::size_t i = 0; i < kKinds.size(); ++i) {
    if (kind == kKinds.at(i)) return static_cast<Fault::Kind>(i);
  }
  return Fault::Kind::drop;
}

Fault parse_fault(TomlTable table) {
  Fault fault;
  fault.kind = kind_of(table);
  if (table.has("frame") == table.has("at_s")) {
    table.fail("frame", "and at_s stand together or are both missing", "give one of the two");
  }
  if (table.has("frame")) fault.frame = table.integer("frame", 0, {0, kMaxFrames});
  fault.at_s = table.number("at_s", 0, {0, kMaxSeconds});
  switch (fault.kind) {
    case Fault::Kind::drop:
    case Fault::Kind::duplicate:
    case Fault::Kind::corrupt:
      fault.count = table.integer("count", 1, {1, kMaxFrames});
      break;
    case Fault::Kind::late:
      fault.count = table.integer("count", 1, {1, kMaxFrames});
      fault.duration_s = table.required_number("duration_s", {0, kMaxSeconds});
      break;
    case Fault::Kind::stall:
    case Fault::Kind::unplug:
      fault.duration_s = table.required_number("duration_s", {0, kMaxSeconds});
      break;
    case Fault::Kind::clock_step:
      fault.step_s = table.required_number("step_s", {-kMaxSeconds, kMaxSeconds});
      break;
  }
  table.done();
  return fault;
}

}  // namespace

std::vector<Fault> read_faults(const std::filesystem::path& path) {
  const toml::table script = parse_toml(read_text_file(path, kMaxScriptBytes), path);
  for (const auto& [key, node] : script) {
    if (key.str() != "fault" || !node.is_array_of_tables()) {
      throw ConfigError(path, std::string(key.str()), "is not a known key",
                        "write [[fault]] tables");
    }
  }
  std::vector<Fault> faults;
  if (const toml::array* tables = script["fault"].as_array()) {
    for (const toml::node& table : *tables) {
      const std::string prefix = "fault[" + std::to_string(faults.size()) + "]";
      faults.push_back(parse_fault({*table.as_table(), path, prefix}));
    }
  }
  return faults;
}

}  // namespace bole
