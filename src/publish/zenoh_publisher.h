#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "publish/publisher.h"
#include "publish/zenoh_session.h"

namespace bole {

/// What queries beside the last list and status are answered with.
struct ZenohAnswers {
  std::string configuration;  ///< TOML
  std::string calibration;    ///< JSON: camera.toml and the calibration file, each as it is
};

/// Messages over Zenoh. The session opens in the background, for which the first message waits up
/// to a second; while it is not open, or has lost the peers that it was told to connect to,
/// publishing is an error. What zenoh itself warns of is logged the first time, then when it came
/// 10, 100 .. times.
class ZenohPublisher : public Publisher {
 public:
  /// Throws ConfigError as ZenohSession does.
  ZenohPublisher(const ZenohConfig& config, const ZenohIdentity& identity,
                 const ZenohAnswers& answers);

  std::string name() const override { return "zenoh"; }
  void publish(MessageKind kind, std::span<const std::byte> bytes,
               const std::string& file) override;

 private:
  /// Why nothing can be published now; empty when it can.
  std::string trouble() const;
  void await_opening() const;
  void log_warnings();

  ZenohSession session_;
  const bool connects_;  // to endpoints that it was told
  bool awaited_ = false;
  std::map<std::string, std::uint64_t> warned_;  // how often
};

}  // namespace bole
