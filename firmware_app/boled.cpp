#include <filesystem>
#include <optional>

#include "base/stop_signals.h"
#include "program.h"
#include "service/daemon.h"

namespace {

constexpr const char* kDefaultConfig = "/etc/bole/boled.toml";

// What the command line says, as settings laid over the file's.
struct Options {
  std::string config;
  std::vector<std::string> publish;
  std::vector<bole::Setting> settings;
};

std::string list_of(const std::vector<std::string>& texts) {
  std::string toml;
  for (const std::string& text : texts) toml += (toml.empty() ? "" : ", ") + bole::toml_text(text);
  return "[" + toml + "]";
}

void add_options(CLI::App& app, Options& options) {
  const auto text = [&](const char* option, const char* key, const char* help) {
    app.add_option_function<std::string>(
        option,
        [&options, key](const std::string& value) {
          options.settings.push_back({key, bole::toml_text(value)});
        },
        help);
  };
  const auto number = [&](const char* option, const char* key, const char* help) {
    app.add_option_function<std::string>(
        option,
        [&options, key](const std::string& value) {
          options.settings.push_back({key, value});
        },
        help);
  };
  app.add_option(
      "--config", options.config,
      std::string("Configuration; by default ") + kDefaultConfig + " where there is one");
  text("--camera", "camera.file", "camera.toml");
  text("--source", "source.uri", "v4l2:DEVICE, libcamera:ID or replay:PATH");
  text("--pace", "source.pace", "Of a replay: realtime, rate:N, fast or lockstep");
  app.add_flag_function(
      "--loop",
      [&](std::int64_t) {
        options.settings.push_back({"source.loop", "true"});
      },
      "Replay again and again");
  app.add_flag_function(
      "--restamp",
      [&](std::int64_t) {
        options.settings.push_back({"source.restamp", "true"});
      },
      "Stamp replayed frames with the time of the replay");
  number("--start", "source.start_s", "Of a replay: seconds to leave out at the start");
  number("--end", "source.end_s", "Of a replay: seconds after which it ends");
  text("--faults", "source.faults", "Of a replay: a script of what goes wrong");
  app.add_option("--publish", options.publish,
                 "lcm, zenoh, jsonl:PATH, jsonl:- for standard output")
      ->delimiter(',');
  app.add_option_function<std::vector<std::string>>(
         "--set",
         [&](const std::vector<std::string>& pairs) {
           for (const auto& pair : pairs) options.settings.push_back(bole::parse_setting(pair));
         },
         "KEY=VALUE of the configuration, as TOML; a bare word is a string")
      ->allow_extra_args(false);
}

void run(const Options& options) {
  std::optional<std::filesystem::path> file;
  if (!options.config.empty()) {
    file = options.config;
  } else if (std::filesystem::exists(kDefaultConfig)) {
    file = kDefaultConfig;
  }
  std::vector<bole::Setting> settings = options.settings;
  if (!options.publish.empty()) settings.push_back({"publish.to", list_of(options.publish)});
  const bole::DaemonConfig config = bole::load_daemon_config(file, settings);
  const bole::StopSignals stop;
  bole::run_daemon(config, BOLE_VERSION, stop.fd());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Finds tree trunks around a robot and publishes them", "boled"};
  Options options;
  add_options(app, options);
  app.callback([&] { run(options); });
  return bole::run_program(app, argc, argv);
}
