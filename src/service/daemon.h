#pragma once

#include <string>

#include "service/daemon_config.h"

namespace bole {

/// Runs a daemon: refuses what is damaged or does not fit (ConfigError) before it touches the
/// camera, then runs until a replay ends or SIGINT or SIGTERM comes; until the table is there,
/// these end the process as they do by default. A replay is summed up in the log. Throws
/// std::runtime_error when lists of a replay in lockstep could not be written to a file.
///
/// When standard output is the only bus and its reader goes, it ends as at SIGTERM: without an
/// error, but for a replay in lockstep, which has lost lists.
void run_daemon(const DaemonConfig& config, const std::string& version);

}  // namespace bole
