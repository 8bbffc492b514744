#pragma once

#include <atomic>
#include <cstdint>

#include "base/wakeup.h"

namespace bole {

/// The time that a running pipeline lives by: the computer's, or that of the files it replays.
class Clock {
 public:
  virtual ~Clock() = default;

  /// Nanoseconds that never run backwards; CLOCK_MONOTONIC on the system's clock.
  virtual std::int64_t mono_ns() const = 0;
  /// UTC microseconds since 1970; may be stepped at any time.
  virtual std::int64_t utc_us() const = 0;
  /// Returns true once mono_ns() has reached `deadline_ns`; false as soon as `wakeup` is raised.
  virtual bool sleep_until(std::int64_t deadline_ns, const Wakeup& wakeup) = 0;
};

/// CLOCK_MONOTONIC and CLOCK_REALTIME.
class SystemClock : public Clock {
 public:
  std::int64_t mono_ns() const override;
  std::int64_t utc_us() const override;
  bool sleep_until(std::int64_t deadline_ns, const Wakeup& wakeup) override;
};

/// Time that passes only when it is told to: a replayed frame sets it to its own stamp, and a sleep
/// jumps to its end. Both readings tell the same instant. Safe to use from several threads.
class ReplayClock : public Clock {
 public:
  explicit ReplayClock(std::int64_t start_ns = 0) : now_ns_(start_ns) {}

  std::int64_t mono_ns() const override { return now_ns_.load(std::memory_order_acquire); }
  std::int64_t utc_us() const override { return mono_ns() / 1000; }
  bool sleep_until(std::int64_t deadline_ns, const Wakeup& wakeup) override;
  /// Sets the time to `now_ns`, unless it is later already.
  void advance_to(std::int64_t now_ns);

 private:
  std::atomic<std::int64_t> now_ns_;
};

}  // namespace bole
