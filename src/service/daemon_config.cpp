#include "service/daemon_config.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <span>
#include <sstream>

#include "base/checksum.h"
#include "base/errors.h"
#include "base/files.h"
#include "publish/tree_list.h"

namespace bole {
namespace {

constexpr std::size_t kMostConfigBytes = 1 << 20;

bool is_word(std::string_view text) {
  return text.find_first_of("\"'[]{}\n\r") == std::string_view::npos;
}

bool is_key_character(unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; }

// The value as TOML, under the key "value".
toml::table parse_value(const Setting& setting) {
  try {
    if (setting.value.find_first_of("\n\r") == std::string::npos) {
      return toml::parse("value = " + setting.value);
    }
  } catch (const toml::parse_error&) {
    if (is_word(setting.value)) return toml::table{{"value", setting.value}};
  }
  throw ConfigError("--set", setting.key, "is not TOML: " + setting.value,
                    "for instance zenoh.mode=\"client\"");
}

void lay_over(toml::table& root, const Setting& setting) {
  refuse_deep_keys(setting.key + setting.value, "--set");
  toml::table* table = &root;
  std::string_view rest = setting.key;
  for (std::size_t dot; (dot = rest.find('.')) != std::string_view::npos;
       rest.remove_prefix(dot + 1)) {
    const std::string_view name = rest.substr(0, dot);
    if (!table->contains(name)) table->insert(name, toml::table{});
    table = (*table)[name].as_table();
    if (table == nullptr) throw ConfigError("--set", setting.key, "goes through a value", "");
  }
  table->insert_or_assign(rest, *parse_value(setting).get("value"));
}

void resolve_after(toml::node* node, std::string_view prefix, const std::filesystem::path& folder) {
  toml::value<std::string>* text = node == nullptr ? nullptr : node->as_string();
  if (text == nullptr || !text->get().starts_with(prefix))
    return;  // what it is instead is told later
  const std::string path = text->get().substr(prefix.size());
  if (path.empty() || path == "-") return;
  *text = std::string(prefix) + (folder / path).lexically_normal().string();
}

// Paths in a file are relative to its own folder, wherever the daemon is started.
void resolve_paths(toml::table& root, const std::filesystem::path& folder) {
  for (const char* key : {"camera.file", "camera.table", "camera.cache_directory", "source.faults",
                          "zenoh.config_file", "zenoh.tls.ca", "zenoh.tls.certificate",
                          "zenoh.tls.private_key", "service.trace"}) {
    resolve_after(root.at_path(key).node(), "", folder);
  }
  resolve_after(root.at_path("source.uri").node(), "replay:", folder);
  if (toml::array* targets = root.at_path("publish.to").as_array()) {
    for (toml::node& target : *targets) resolve_after(&target, "jsonl:", folder);
  }
}

std::string default_camera_name(const std::filesystem::path& camera_toml) {
  const auto file = std::filesystem::absolute(camera_toml).lexically_normal();
  std::string name = file.parent_path().filename().string();
  std::ranges::replace_if(
      name, [](unsigned char c) { return !is_key_character(c); }, '_');
  name.resize(std::min(name.size(), kMostCameraBytes));
  return name.empty() ? "camera" : name;
}

// A name that is also a part of Zenoh's keys.
std::string key_name(TomlTable& table, std::string_view key, const std::string& fallback,
                     std::size_t most) {
  std::string name = table.text(key, fallback);
  if (name.empty() || name.size() > most || !std::ranges::all_of(name, is_key_character)) {
    table.fail(key, "is \"" + name + "\"",
               "1 to " + std::to_string(most) + " letters, digits, _ and -");
  }
  return name;
}

void read_camera(TomlTable table, DaemonConfig::CameraPart& camera) {
  camera.file = table.text("file", camera.file.string());
  camera.name = key_name(table, "name", default_camera_name(camera.file), kMostCameraBytes);
  camera.table = table.text("table", "");
  camera.cache_directory = table.text("cache_directory", "");
  table.done();
}

void read_source(TomlTable table, DaemonConfig::SourcePart& source) {
  source.uri = table.text("uri", "");
  source.pace = table.text("pace", source.pace);
  source.loop = table.boolean("loop", source.loop);
  source.restamp = table.boolean("restamp", source.restamp);
  constexpr Bounds kSeconds{0, 1e9};
  source.start = table.number("start_s", source.start, kSeconds);
  if (table.has("end_s")) source.end = table.required_number("end_s", kSeconds);
  source.rate = table.number("rate_hz", source.rate, {0.01, 1000});
  source.faults = table.text("faults", "");
  source.camera = read_camera_settings(table);
  table.done();
}

void read_detect(TomlTable table, DaemonConfig::DetectPart& detect) {
  detect.mode = *detector_mode_from_name(table.choice("mode", "bole", {"bole", "paper"}));
  detect.track = table.boolean("track", detect.track);
  table.done();
}

PublishTarget target(const TomlTable& table, const std::string& text) {
  if (text == "lcm") return {PublishTarget::Bus::lcm, {}};
  if (text == "zenoh") return {PublishTarget::Bus::zenoh, {}};
  constexpr std::string_view kJsonl = "jsonl:";
  if (text.starts_with(kJsonl) && text.size() > kJsonl.size()) {
    return {PublishTarget::Bus::jsonl, text.substr(kJsonl.size())};
  }
  table.fail("to", "names \"" + text + "\"", "must be lcm, zenoh, jsonl:PATH or jsonl:-");
}

void read_publish(TomlTable table, DaemonConfig::PublishPart& publish) {
  const std::vector<std::string> texts = table.texts("to", {"lcm"});
  if (texts.empty()) table.fail("to", "is empty", "name lcm, zenoh, jsonl:PATH or several of them");
  for (const std::string& text : texts) {
    publish.to.push_back(target(table, text));
    if (std::ranges::count(texts, text) > 1) table.fail("to", "names " + text + " twice", "");
  }
  publish.min_score = table.number("min_score", publish.min_score, {0, 1});
  publish.robot = key_name(table, "robot", publish.robot, 64);
  table.done();
}

void read_zenoh(TomlTable table, ZenohConfig& zenoh) {
  if (table.has("mode")) zenoh.mode = table.choice("mode", "", {"peer", "client", "router"});
  zenoh.listen = table.texts("listen", {});
  zenoh.connect = table.texts("connect", {});
  if (table.has("multicast_scouting")) {
    zenoh.multicast_scouting = table.boolean("multicast_scouting", false);
  }
  TomlTable tls = table.table("tls");
  zenoh.tls.ca = tls.text("ca", "");
  zenoh.tls.certificate = tls.text("certificate", "");
  zenoh.tls.private_key = tls.text("private_key", "");
  if (tls.has("mutual")) zenoh.tls.mutual = tls.boolean("mutual", false);
  tls.done();
  zenoh.config_file = table.text("config_file", "");
  table.done();
}

void read_service(TomlTable table, DaemonConfig::ServicePart& service) {
  service.realtime_priority = table.integer("realtime_priority", 0, {0, 99});
  service.lock_memory = table.boolean("lock_memory", false);
  service.trace = table.text("trace", "");
  table.done();
}

}  // namespace

Setting parse_setting(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos || equals == 0) {
    throw ConfigError("--set", std::string(text), "is not key=value",
                      "for instance publish.min_score=0.6");
  }
  return {std::string(text.substr(0, equals)), std::string(text.substr(equals + 1))};
}

std::string toml_text(std::string_view text) {
  std::string toml = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') toml += '\\';
    toml += c;
  }
  return toml + '"';
}

DaemonConfig load_daemon_config(const std::optional<std::filesystem::path>& file,
                                const std::vector<Setting>& settings) {
  std::string origin = file ? file->string() : "command line";
  toml::table merged =
      file ? parse_toml(read_text_file(*file, kMostConfigBytes), origin) : toml::table{};
  if (file) resolve_paths(merged, std::filesystem::absolute(*file).parent_path());
  for (const Setting& setting : settings) lay_over(merged, setting);
  if (file && !settings.empty()) origin += " with the command line";

  TomlTable root(merged, origin);
  DaemonConfig config;
  read_camera(root.table("camera"), config.camera);
  read_source(root.table("source"), config.source);
  read_detect(root.table("detect"), config.detect);
  read_publish(root.table("publish"), config.publish);
  TomlTable lcm = root.table("lcm");
  config.lcm = parse_lcm_url(lcm.text("url", kDefaultLcmUrl), origin, "lcm.url");
  lcm.done();
  config.file = config.zenoh.file = origin;
  read_zenoh(root.table("zenoh"), config.zenoh);
  read_service(root.table("service"), config.service);
  root.done();
  std::ostringstream text;
  text << merged << '\n';
  config.text = text.str();
  return config;
}

std::uint32_t config_crc(const DaemonConfig& config, std::uint32_t camera_digest) {
  std::ostringstream text;
  text << camera_digest << ' ' << config.camera.name << ' ' << static_cast<int>(config.detect.mode)
       << ' ' << config.detect.track << ' ' << config.publish.min_score;
  const std::string line = text.str();
  return crc32(std::as_bytes(std::span(line)));
}

}  // namespace bole
