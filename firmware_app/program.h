#pragma once

#include <CLI/CLI.hpp>

namespace bole {

/// What boled and bolectl share: lets `set_up` add options and callbacks, parses the command line,
/// runs the callbacks, turns exceptions into one line on standard error. Returns the exit code: 0
/// done, 2 wrong usage or configuration (ConfigError), 1 anything else.
int run_program(const char* name, const char* description, void (*set_up)(CLI::App&), int argc,
                char** argv);

/// Throws std::runtime_error when what was written to standard output cannot reach it.
void flush_output();

}  // namespace bole
