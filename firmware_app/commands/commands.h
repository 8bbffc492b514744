#pragma once

#include <CLI/CLI.hpp>

namespace bole {

// Each adds one subcommand of bolectl with its options and what it does. A command that fails
// throws: ConfigError for exit code 2, any other exception for 1.

void add_calib(CLI::App& app);
void add_cameras(CLI::App& app);
void add_detect(CLI::App& app);
void add_doctor(CLI::App& app);
void add_eval(CLI::App& app);
void add_grab(CLI::App& app);
void add_listen(CLI::App& app);
void add_lut(CLI::App& app);
void add_publish_fake(CLI::App& app);
void add_sim(CLI::App& app);

}  // namespace bole
