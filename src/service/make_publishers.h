#pragma once

#include <memory>
#include <string>
#include <vector>

#include "publish/jsonl_publisher.h"
#include "service/daemon_config.h"

namespace bole {

/// The buses that the configuration names, in its order. `calibration`: what queries for it are
/// answered with, JSON. `earlier`: what becomes of lists in files. Throws ConfigError for one that
/// cannot be: a file that cannot be written, a bus that this build does not have.
std::vector<std::unique_ptr<Publisher>> make_publishers(const DaemonConfig& config,
                                                        const std::string& calibration,
                                                        JsonlPublisher::Earlier earlier);

/// Where the lists for `target` go, for people: the bus and its address.
std::string address(const PublishTarget& target, const DaemonConfig& config);

}  // namespace bole
