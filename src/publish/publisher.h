#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace bole {

/// A tree list or a status in its wire form, with what jsonl needs beside it.
enum class MessageKind { trees, status };

/// One bus. Used by one thread of its own, so that a slow bus delays nothing else.
class Publisher {
 public:
  virtual ~Publisher() = default;

  /// "lcm", "zenoh", "jsonl": as in --publish and in status_t.
  virtual std::string name() const = 0;
  /// Hands `bytes`, the LCM encoding of the message, to the bus. Throws BusError when the bus
  /// refuses it; the next message is tried anew.
  virtual void publish(MessageKind kind, std::span<const std::byte> bytes,
                       const std::string& file) = 0;
};

}  // namespace bole
