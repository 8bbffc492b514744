#include "service/make_publishers.h"

#include "base/errors.h"
#include "publish/jsonl_publisher.h"
#include "publish/lcm_publisher.h"

namespace bole {
namespace {

std::unique_ptr<Publisher> make_publisher(const PublishTarget& target, const DaemonConfig& config) {
  switch (target.bus) {
    case PublishTarget::Bus::lcm:
      return std::make_unique<LcmPublisher>(config.lcm);
    case PublishTarget::Bus::jsonl:
      return std::make_unique<JsonlPublisher>(target.path);
    case PublishTarget::Bus::zenoh:
      break;
  }
  throw ConfigError("publish", "zenoh", "is not in this build", "install cargo and build again");
}

}  // namespace

std::vector<std::unique_ptr<Publisher>> make_publishers(const DaemonConfig& config) {
  std::vector<std::unique_ptr<Publisher>> publishers;
  for (const PublishTarget& target : config.publish.to) {
    publishers.push_back(make_publisher(target, config));
  }
  return publishers;
}

}  // namespace bole
