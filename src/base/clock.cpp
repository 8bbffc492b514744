#include "base/clock.h"

#include <ctime>

namespace bole {
namespace {

std::int64_t read_ns(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return now.tv_sec * std::int64_t{1'000'000'000} + now.tv_nsec;
}

}  // namespace

std::int64_t SystemClock::mono_ns() const { return read_ns(CLOCK_MONOTONIC); }

std::int64_t SystemClock::utc_us() const { return read_ns(CLOCK_REALTIME) / 1000; }

bool SystemClock::sleep_until(std::int64_t deadline_ns, const Wakeup& wakeup) {
  while (true) {
    const std::int64_t left_ns = deadline_ns - mono_ns();
    if (wakeup.wait(left_ns)) return false;
    if (mono_ns() >= deadline_ns) return true;
  }
}

bool ReplayClock::sleep_until(std::int64_t deadline_ns, const Wakeup& wakeup) {
  if (wakeup.wait(0)) return false;
  advance_to(deadline_ns);
  return true;
}

void ReplayClock::advance_to(std::int64_t now_ns) {
  std::int64_t before = now_ns_.load(std::memory_order_relaxed);
  while (before < now_ns &&
         !now_ns_.compare_exchange_weak(before, now_ns, std::memory_order_acq_rel)) {
  }
}

}  // namespace bole
