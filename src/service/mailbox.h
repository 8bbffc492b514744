#pragma once

#include <array>
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

namespace bole {

/// What put() does when the slot's last value was not taken yet.
enum class WhenFull {
  overwrite,  ///< newest wins: a live pipeline
  wait,       ///< nothing is lost: a replay in lockstep
};

/// What the takers of one or several mailboxes wait for. Threads that are woken one by one delay
/// each other: the first one woken often takes the processor from the thread that was about to wake
/// the next. A single ring() makes all of them runnable before any of them runs.
struct Doorbell {
  std::mutex mutex;  // guards the slots of the mailboxes that share it
  std::condition_variable rung;

  void ring() { rung.notify_all(); }
};

/// Hands values from one thread to another through `Slots` slots of one value each; the lower slot
/// is taken first. Values are swapped in and out, so that what they own (capacity of a vector,
/// buffer of a frame) goes round and nothing is allocated.
template <typename T, std::size_t Slots = 1>
class Mailbox {
 public:
  /// Mailboxes with the same `bell` share the calls that wake their takers.
  explicit Mailbox(std::shared_ptr<Doorbell> bell = std::make_shared<Doorbell>())
      : bell_(std::move(bell)) {}

  /// Swaps `value` into the slot; its taker wakes when the bell is rung. True when that overwrote a
  /// value which nobody took; `value` holds it then, for the caller to drop outside of the lock.
  /// Does nothing once closed.
  bool lay(T& value, WhenFull when_full, std::size_t slot = 0) {
    std::unique_lock lock(bell_->mutex);
    if (when_full == WhenFull::wait) {
      emptied_.wait(lock, [&] { return closed_ || !slots_.at(slot).full; });
    }
    if (closed_) return false;
    std::swap(slots_.at(slot).value, value);
    return std::exchange(slots_.at(slot).full, true);
  }

  /// lay(), and rings.
  bool put(T& value, WhenFull when_full, std::size_t slot = 0) {
    const bool overwritten = lay(value, when_full, slot);
    bell_->ring();
    return overwritten;
  }

  /// Waits for a value, swaps it into `value` and returns its slot; nullopt once the mailbox is
  /// closed and empty.
  std::optional<std::size_t> take(T& value) {
    std::unique_lock lock(bell_->mutex);
    std::optional<std::size_t> slot;
    bell_->rung.wait(lock, [&] { return (slot = first_full()) || closed_; });
    if (!slot) return std::nullopt;
    std::swap(slots_.at(*slot).value, value);
    slots_.at(*slot).full = false;
    lock.unlock();
    emptied_.notify_all();
    return slot;
  }

  /// Nothing more is put; what is there can still be taken. Whoever waits in put() returns.
  void close() {
    {
      const std::lock_guard lock(bell_->mutex);
      closed_ = true;
    }
    bell_->ring();
    emptied_.notify_all();
  }

 private:
  struct Slot {
    T value{};
    bool full = false;
  };

  std::optional<std::size_t> first_full() const {
    for (std::size_t slot = 0; slot < Slots; ++slot) {
      if (slots_[slot].full) return slot;
    }
    return std::nullopt;
  }

  std::shared_ptr<Doorbell> bell_;
  std::condition_variable emptied_;
  std::array<Slot, Slots> slots_;
  bool closed_ = false;
};

}  // namespace bole
