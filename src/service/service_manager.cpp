#include "service/service_manager.h"

#include <systemd/sd-daemon.h>

#include "base/clock.h"

namespace bole {
namespace {

std::int64_t feed_period_ns() {
  std::uint64_t watchdog_us = 0;
  if (sd_watchdog_enabled(0, &watchdog_us) <= 0) return 0;
  return static_cast<std::int64_t>(watchdog_us) * 1000 / 4;
}

}  // namespace

ServiceManager::ServiceManager() : feed_every_ns_(feed_period_ns()) {}

void ServiceManager::ready() {
  if (!ready_.exchange(true)) sd_notify(0, "READY=1");
}

void ServiceManager::status(const std::string& line) { sd_notify(0, ("STATUS=" + line).c_str()); }

void ServiceManager::progress() {
  if (feed_every_ns_ == 0) return;
  const std::int64_t now_ns = SystemClock().mono_ns();
  std::int64_t fed_ns = fed_ns_.load(std::memory_order_relaxed);
  if (now_ns - fed_ns < feed_every_ns_) return;
  if (fed_ns_.compare_exchange_strong(fed_ns, now_ns)) sd_notify(0, "WATCHDOG=1");
}

void ServiceManager::stopping() { sd_notify(0, "STOPPING=1"); }

}  // namespace bole
