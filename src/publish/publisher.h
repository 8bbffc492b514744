#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>

namespace bole {

enum class MessageKind { status, trees };

/// Why a bus did not take a message. The next one is tried anew: the bus may come back.
class BusError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Why a bus takes no message any more, ever.
class BusGone : public BusError {
 public:
  using BusError::BusError;
};

/// One bus. Used by one thread of its own, so that a slow bus delays nothing else.
class Publisher {
 public:
  virtual ~Publisher() = default;

  /// "lcm", "zenoh", "jsonl": as in --publish and in status_t.
  virtual std::string name() const = 0;
  /// False for a kind that the bus has no place for; publish() is not called with it.
  virtual bool carries(MessageKind /*kind*/) const { return true; }
  /// Hands `bytes`, the LCM encoding of the message, to the bus. `file` is the replayed file's
  /// name, empty for a camera. Throws BusError when the bus does not take it.
  virtual void publish(MessageKind kind, std::span<const std::byte> bytes,
                       const std::string& file) = 0;
  /// Makes a publish() that waits, and all later ones, give up. From any thread.
  virtual void interrupt() noexcept {}
};

}  // namespace bole
