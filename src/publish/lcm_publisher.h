#pragma once

#include <memory>

#include <lcm/lcm.h>

#include "publish/lcm_url.h"
#include "publish/publisher.h"

namespace bole {

constexpr const char* kTreesChannel = "BOLE_TREES";
constexpr const char* kStatusChannel = "BOLE_STATUS";

struct LcmDestroyer {
  void operator()(lcm_t* lcm) const { lcm_destroy(lcm); }
};
using LcmHandle = std::unique_ptr<lcm_t, LcmDestroyer>;

/// Messages over LCM's UDP multicast. Connects at the first message and again after a failure, so
/// that a network which comes later is found.
class LcmPublisher : public Publisher {
 public:
  explicit LcmPublisher(LcmUrl url) : url_(std::move(url)) {}

  std::string name() const override { return "lcm"; }
  void publish(MessageKind kind, std::span<const std::byte> bytes,
               const std::string& file) override;

 private:
  void connect();

  LcmUrl url_;
  LcmHandle lcm_;
};

}  // namespace bole
