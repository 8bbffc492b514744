#include "daemon_options.h"

#include <filesystem>
#include <optional>

namespace bole {
namespace {

constexpr const char* kDefaultConfig = "/etc/bole/boled.toml";

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
         [options, key](const std::string& value) {
           options->settings.push_back({key, value});
         },
         help)
      ->type_name("SECONDS");
}

void add_switch(CLI::App& app, const Options& options, const char* option, const char* key,
                const char* help) {
  app.add_flag_function(
      option,
      [options, key](std::int64_t) {
        options->settings.push_back({key, "true"});
      },
      help);
}

}  // namespace

void add_text_option(CLI::App& app, const Options& options, const char* option, const char* key,
                     const char* help) {
  app.add_option_function<std::string>(
      option,
      [options, key](const std::string& value) {
        options->settings.push_back({key, toml_text(value)});
      },
      help);
}

DaemonConfig DaemonOptions::load() const {
  std::optional<std::filesystem::path> file;
  if (!config.empty()) {
    file = config;
  } else if (std::filesystem::exists(kDefaultConfig)) {
    file = kDefaultConfig;
  }
  std::vector<Setting> all = settings;
  if (!publish.empty()) all.push_back({"publish.to", list_of(publish)});
  return load_daemon_config(file, all);
}

std::shared_ptr<DaemonOptions> add_daemon_options(CLI::App& app) {
  auto options = std::make_shared<DaemonOptions>();
  app.add_option(
      "--config", options->config,
      std::string("Configuration; by default ") + kDefaultConfig + " where there is one");
  add_text_option(app, options, "--camera", "camera.file", "camera.toml");
  add_text_option(app, options, "--source", "source.uri",
                  "v4l2:DEVICE, libcamera:ID or replay:PATH");
  app.add_option("--publish", options->publish,
                 "lcm, zenoh, jsonl:PATH, jsonl:- for standard output; several with commas")
      ->delimiter(',');
  app.add_option_function<std::vector<std::string>>(
         "--set",
         [options](const std::vector<std::string>& pairs) {
           for (const auto& pair : pairs) options->settings.push_back(parse_setting(pair));
         },
         "KEY=VALUE of the configuration, as TOML; a bare word is a string")
      ->allow_extra_args(false);
  return options;
}

void add_replay_options(CLI::App& app, const Options& options) {
  add_text_option(app, options, "--pace", "source.pace",
                  "Of a replay: realtime, rate:N, fast, lockstep");
  add_switch(app, options, "--loop", "source.loop", "Replay again and again");
  add_switch(app, options, "--restamp", "source.restamp",
             "Stamp replayed frames with the time of the replay");
  add_seconds(app, options, "--start", "source.start_s", "Of a replay: what to leave out");
  add_seconds(app, options, "--end", "source.end_s", "Of a replay: when it ends");
  add_text_option(app, options, "--faults", "source.faults",
                  "Of a replay: a script of what goes wrong");
}

}  // namespace bole
