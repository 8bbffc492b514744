#include "daemon_options.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>

#include "base/errors.h"

namespace bole {
namespace {

constexpr const char* kDefaultConfig = "/etc/bole/boled.toml";
constexpr const char* kReplayGroup = "Of a replay";  // in --help

std::string list_of(const std::vector<std::string>& texts) {
  std::string toml;
  for (const std::string& text : texts) toml += (toml.empty() ? "" : ", ") + toml_text(text);
  return "[" + toml + "]";
}

using Options = std::shared_ptr<DaemonOptions>;

void add_seconds(CLI::App& app, const Options& options, const char* option, const char* key,
                 const char* help) {
  app.add_option_function<std::string>(
         option,
         [options, option, key](const std::string& value) {
           options->named.push_back({option, {key, value}});
         },
         help)
      ->type_name("SECONDS")
      ->group(kReplayGroup);
}

void add_switch(CLI::App& app, const Options& options, const char* option, const char* key,
                const char* help) {
  app.add_flag_function(
         option,
         [options, option, key](std::int64_t) {
           options->named.push_back({option, {key, "true"}});
         },
         help)
      ->group(kReplayGroup);
}

}  // namespace

CLI::Option* add_text_option(CLI::App& app, const Options& options, const char* option,
                             const char* key, const char* type, const char* help) {
  return app
      .add_option_function<std::string>(
          option,
          [options, option, key](const std::string& value) {
            options->named.push_back({option, {key, toml_text(value)}});
          },
          help)
      ->type_name(type);
}

DaemonConfig DaemonOptions::load() const {
  std::optional<std::filesystem::path> file;
  if (!config.empty()) {
    file = config;
  } else {
    std::error_code error;  // what may not be looked at is told by its reader
    const auto kind = std::filesystem::status(kDefaultConfig, error).type();
    if (kind != std::filesystem::file_type::not_found) file = kDefaultConfig;
  }
  std::vector<Setting> all = set;
  for (const auto& [option, setting] : named) {
    if (std::ranges::find(set, setting.key, &Setting::key) != set.end()) {
      throw ConfigError("--set", setting.key, "is what " + option + " sets, too",
                        "give one of the two");
    }
    all.push_back(setting);
  }
  return load_daemon_config(file, all);
}

std::shared_ptr<DaemonOptions> add_config_options(CLI::App& app) {
  auto options = std::make_shared<DaemonOptions>();
  app.add_option("--config", options->config,
                 std::string("Configuration; by default ") + kDefaultConfig + " where there is one")
      ->type_name("FILE");
  app.add_option_function<std::vector<std::string>>(
         "--set",
         [options](const std::vector<std::string>& pairs) {
           for (const auto& pair : pairs) options->set.push_back(parse_setting(pair));
         },
         "A key of the configuration and its value as TOML, where a bare word is a string; may be "
         "given again, the last of a key holds")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  return options;
}

std::shared_ptr<DaemonOptions> add_daemon_options(CLI::App& app) {
  auto options = add_config_options(app);
  add_text_option(app, options, "--camera", "camera.file", "FILE",
                  "The camera's camera.toml; by default /etc/bole/camera/camera.toml");
  return options;
}

void add_source_option(CLI::App& app, const Options& options) {
  add_text_option(app, options, "--source", "source.uri", "SOURCE",
                  "v4l2:DEVICE, libcamera:ID or replay:PATH");
}

void add_publish_option(CLI::App& app, const Options& options) {
  app.add_option_function<std::vector<std::string>>(
         "--publish",
         [options](const std::vector<std::string>& targets) {
           options->named.push_back({"--publish", {"publish.to", list_of(targets)}});
         },
         "lcm, zenoh, jsonl:PATH (lists are added to the file; in lockstep it is made anew) or "
         "jsonl:- for standard output; several with commas")
      ->type_name("BUS")
      ->delimiter(',');
}

void add_replay_options(CLI::App& app, const Options& options) {
  add_text_option(app, options, "--pace", "source.pace", "PACE",
                  "realtime (the default), rate:N frames a second, fast, or lockstep: no drops")
      ->group(kReplayGroup);
  add_switch(app, options, "--loop", "source.loop", "Begin again at the end");
  add_switch(app, options, "--restamp", "source.restamp",
             "Stamp frames with the time of the replay, not of the recording");
  add_seconds(app, options, "--start", "source.start_s", "What to leave out at the beginning");
  add_seconds(app, options, "--end", "source.end_s", "When to end, counted from the beginning");
  add_text_option(
      app, options, "--faults", "source.faults", "FILE",
      "A script of what goes wrong with the camera; share/bole/examples/faults.toml shows "
      "every kind")
      ->group(kReplayGroup);
}

}  // namespace bole
