#pragma once

#include <functional>

#include "publish/lcm_publisher.h"

namespace bole {

/// Receives our two channels. Used by one thread.
class LcmSubscriber {
 public:
  /// Called by handle() with the bytes as they came, valid during the call only.
  using Receive = std::function<void(MessageKind, std::span<const std::byte>)>;

  /// Throws BusError when the address cannot be listened on.
  LcmSubscriber(const LcmUrl& url, Receive receive);

  /// Readable when handle() would not wait; for poll().
  int fd() const { return lcm_get_fileno(lcm_.get()); }
  void handle() { lcm_handle(lcm_.get()); }

 private:
  static void on_message(const lcm_recv_buf_t* message, const char* channel, void* self);

  Receive receive_;
  LcmHandle lcm_;
};

}  // namespace bole
