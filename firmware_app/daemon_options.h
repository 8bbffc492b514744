#pragma once

#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "service/daemon_config.h"

namespace bole {

/// The options that lay settings over the daemon's configuration file.
struct DaemonOptions {
  std::string config;
  std::vector<std::string> publish;
  std::vector<Setting> settings;

  /// The configuration that they make: of --config, else of /etc/bole/boled.toml where it is there,
  /// else of the defaults.
  DaemonConfig load() const;
};

/// --config, --camera, --source, --publish and --set.
std::shared_ptr<DaemonOptions> add_daemon_options(CLI::App& app);
/// An option whose text becomes the setting `key`.
void add_text_option(CLI::App& app, const std::shared_ptr<DaemonOptions>& options,
                     const char* option, const char* key, const char* help);
/// --pace, --loop and what else a replay needs.
void add_replay_options(CLI::App& app, const std::shared_ptr<DaemonOptions>& options);

}  // namespace bole
