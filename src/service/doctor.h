#pragma once

#include <string>
#include <vector>

#include "service/daemon_config.h"

namespace bole {

/// What became of one check; where it is not good, `detail` says what is wrong and what mends it.
struct Finding {
  std::string check;
  bool good = false;
  std::string detail;
};

/// Checks what a daemon of this configuration needs: the camera's files, its table, the source, the
/// buses, the trace. Leaves nothing behind and streams nothing. Where another user may find
/// otherwise, `detail` says as which user it was checked and, unless that is the service's, what
/// holds for the service.
std::vector<Finding> examine(const DaemonConfig& config);

}  // namespace bole
