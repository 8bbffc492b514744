#pragma once

#include <string>

#include "service/daemon_config.h"

namespace bole {

/// Runs a daemon: refuses what is damaged or does not fit (ConfigError) before it touches the
/// camera, then runs until a replay ends or `stop_fd` becomes readable. A replay is summed up in
/// the log. Throws std::runtime_error when lists of a replay in lockstep could not
/// be written to a file.
void run_daemon(const DaemonConfig& config, const std::string& version, int stop_fd);

}  // namespace bole
