#include "service/make_publishers.h"

#include "base/errors.h"
#include "publish/lcm_publisher.h"
#ifdef BOLE_ZENOH
#include "publish/zenoh_publisher.h"
#endif

namespace bole {
namespace {

#ifdef BOLE_ZENOH
std::unique_ptr<Publisher> make_zenoh(const DaemonConfig& config, const std::string& calibration) {
  return std::make_unique<ZenohPublisher>(config.zenoh,
                                          ZenohIdentity{config.publish.robot, config.camera.name},
                                          ZenohAnswers{config.text, calibration});
}
#else
std::unique_ptr<Publisher> make_zenoh(const DaemonConfig& config,
                                      const std::string& /*calibration*/) {
  throw ConfigError(config.file, "publish.to", "names zenoh, which is not in this build",
                    "install cargo and build again");
}
#endif

std::unique_ptr<Publisher> make_publisher(const PublishTarget& target, const DaemonConfig& config,
                                          const std::string& calibration,
                                          JsonlPublisher::Earlier earlier) {
  switch (target.bus) {
    case PublishTarget::Bus::lcm:
      return std::make_unique<LcmPublisher>(config.lcm);
    case PublishTarget::Bus::jsonl:
      return std::make_unique<JsonlPublisher>(target.path, earlier, config.file);
    case PublishTarget::Bus::zenoh:
      break;
  }
  return make_zenoh(config, calibration);
}

std::string zenoh_address(const ZenohConfig& zenoh) {
  std::string text;
  for (const std::string& endpoint : zenoh.listen) text += ", listens on " + endpoint;
  for (const std::string& endpoint : zenoh.connect) text += ", connects to " + endpoint;
  if (!zenoh.config_file.empty()) text += ", by " + zenoh.config_file;
  if (text.empty()) text = std::string(", listens on ") + kDefaultZenohEndpoint;
  return "zenoh (" + text.substr(2) + ")";
}

}  // namespace

std::string address(const PublishTarget& target, const DaemonConfig& config) {
  switch (target.bus) {
    case PublishTarget::Bus::lcm:
      return "lcm (" + config.lcm.text() + ")";
    case PublishTarget::Bus::jsonl:
      return "jsonl (" + (target.path == "-" ? "standard output" : target.path.string()) + ")";
    case PublishTarget::Bus::zenoh:
      break;
  }
  return zenoh_address(config.zenoh);
}

std::vector<std::unique_ptr<Publisher>> make_publishers(const DaemonConfig& config,
                                                        const std::string& calibration,
                                                        JsonlPublisher::Earlier earlier) {
  std::vector<std::unique_ptr<Publisher>> publishers;
  for (const PublishTarget& target : config.publish.to) {
    publishers.push_back(make_publisher(target, config, calibration, earlier));
  }
  return publishers;
}

}  // namespace bole
