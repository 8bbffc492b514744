#pragma once

#include <atomic>
#include <cstdint>
#include <string>

namespace bole {

/// Tells systemd, where it started us, how we are doing. Does nothing elsewhere. Any thread may
/// call it.
class ServiceManager {
 public:
  ServiceManager();

  /// The start is over: a frame was processed, or the camera is properly being waited for. Told
  /// once.
  void ready();
  /// The line that `systemctl status` shows.
  void status(const std::string& line);
  /// Something was achieved: feeds the watchdog, at most as often as it needs it.
  void progress();
  void stopping();

 private:
  const std::int64_t feed_every_ns_;  // 0: no watchdog
  std::atomic<std::int64_t> fed_ns_{0};
  std::atomic<bool> ready_{false};
};

}  // namespace bole
