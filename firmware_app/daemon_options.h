#pragma once

#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "service/daemon_config.h"

namespace bole {

/// The options that lay settings over the daemon's configuration file.
struct DaemonOptions {
  struct Named {
    std::string option;
    Setting setting;
  };
  std::string config;
  std::vector<Setting> set;  ///< by --set
  std::vector<Named> named;  ///< by options of their own

  /// The configuration that they make: of --config, else of /etc/bole/boled.toml where it is there,
  /// else of the defaults. Throws ConfigError where --set and another option set the same key.
  DaemonConfig load() const;
};

/// --config and --set.
std::shared_ptr<DaemonOptions> add_config_options(CLI::App& app);
/// --config, --set and --camera.
std::shared_ptr<DaemonOptions> add_daemon_options(CLI::App& app);
/// --source.
void add_source_option(CLI::App& app, const std::shared_ptr<DaemonOptions>& options);
/// --publish.
void add_publish_option(CLI::App& app, const std::shared_ptr<DaemonOptions>& options);
/// An option whose text becomes the setting `key`; `type` is what --help calls its value.
CLI::Option* add_text_option(CLI::App& app, const std::shared_ptr<DaemonOptions>& options,
                             const char* option, const char* key, const char* type,
                             const char* help);
/// --pace, --loop and what else a replay needs.
void add_replay_options(CLI::App& app, const std::shared_ptr<DaemonOptions>& options);

}  // namespace bole
