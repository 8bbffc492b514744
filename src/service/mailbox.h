#pragma once

#include <array>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <utility>

namespace bole {

/// What put() does when the slot's last value was not taken yet.
enum class WhenFull {
  overwrite,  ///< newest wins: a live pipeline
  wait,       ///< nothing is lost: a replay in lockstep
};

/// Hands values from one thread to another through `Slots` slots of one value each; the lower slot
/// is taken first. Values are swapped in and out, so that what they own (capacity of a vector,
/// buffer of a frame) goes round and nothing is allocated.
template <typename T, std::size_t Slots = 1>
class Mailbox {
 public:
  /// Swaps `value` into the slot. True when that overwrote a value which nobody took; `value` holds
  /// it then, for the caller to drop outside of the lock. Does nothing once closed.
  bool put(T& value, WhenFull when_full, std::size_t slot = 0) {
    std::unique_lock lock(mutex_);
    if (when_full == WhenFull::wait) {
      changed_.wait(lock, [&] { return closed_ || !slots_.at(slot).full; });
    }
    if (closed_) return false;
    std::swap(slots_.at(slot).value, value);
    const bool overwritten = std::exchange(slots_.at(slot).full, true);
    lock.unlock();
    changed_.notify_all();
    return overwritten;
  }

  /// Waits for a value, swaps it into `value` and returns its slot; nullopt once the mailbox is
  /// closed and empty.
  std::optional<std::size_t> take(T& value) {
    std::unique_lock lock(mutex_);
    std::optional<std::size_t> slot;
    changed_.wait(lock, [&] { return (slot = first_full()) || closed_; });
    if (!slot) return std::nullopt;
    std::swap(slots_.at(*slot).value, value);
    slots_.at(*slot).full = false;
    lock.unlock();
    changed_.notify_all();
    return slot;
  }

  /// Nothing more is put; what is there can still be taken. Whoever waits in put() returns.
  void close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    changed_.notify_all();
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

  std::mutex mutex_;
  std::condition_variable changed_;
  std::array<Slot, Slots> slots_;
  bool closed_ = false;
};

}  // namespace bole
