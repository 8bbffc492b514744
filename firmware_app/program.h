#pragma once

#include <CLI/CLI.hpp>

namespace bole {

/// What boled and bolectl share: parses the command line, runs the callbacks, turns exceptions into
/// one line on standard error. Returns the exit code: 0 done, 2 wrong usage or configuration
/// (ConfigError), 1 anything else.
int run_program(CLI::App& app, int argc, char** argv);

}  // namespace bole
