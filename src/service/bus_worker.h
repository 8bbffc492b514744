#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "base/histogram.h"
#include "bole/bus_t.hpp"
#include "publish/publisher.h"
#include "service/mailbox.h"
#include "service/trace.h"

namespace bole {

/// One bus in a thread of its own behind one slot for lists and one for statuses: a bus that is
/// slow, gone or not there yet delays nobody. Each reason for a failure is logged once an outage,
/// then counted.
class BusWorker {
 public:
  /// `when_full` holds for lists; a status is always overwritten by the next. `bell` wakes the
  /// thread, and those of the other buses with it. `on_finished` is called from the bus's thread
  /// when it ends, and when the bus is gone. `trace` may be null.
  BusWorker(std::unique_ptr<Publisher> publisher, WhenFull when_full,
            std::shared_ptr<Doorbell> bell, std::function<void()> on_finished,
            Trace* trace = nullptr);
  ~BusWorker();
  BusWorker(const BusWorker&) = delete;
  BusWorker& operator=(const BusWorker&) = delete;

  /// Leaves a message for the bus, which takes it when the bell is rung. `processed_ns`:
  /// CLOCK_MONOTONIC at the end of processing, from which the hand-over is timed; `seq`: of a list,
  /// for the trace. Called by one thread a kind.
  void offer(MessageKind kind, std::span<const std::byte> bytes, std::string_view file,
             std::int64_t processed_ns, std::int64_t seq = 0);

  /// No more messages: what is in the slots is published, then the thread ends.
  void close() { mailbox_.close(); }
  /// Makes a publish() that waits give up.
  void interrupt() noexcept { publisher_->interrupt(); }
  bool finished() const;
  /// It takes no message any more, ever.
  bool gone() const;

  bus_t health() const;

 private:
  struct Message {
    std::vector<std::byte> bytes;
    std::string file;
    std::int64_t processed_ns = 0;
    std::int64_t seq = 0;
  };

  void run();
  void publish(MessageKind kind, const Message& message);
  void record_success(MessageKind kind, std::int64_t handover_ns);
  void record_failure(MessageKind kind, const std::string& reason);
  void record_gone();

  std::unique_ptr<Publisher> publisher_;
  const WhenFull when_full_;
  std::function<void()> on_finished_;
  Trace* const trace_;
  Mailbox<Message, 2> mailbox_;
  std::array<Message, 2> outgoing_;  // one a kind

  mutable std::mutex mutex_;  // guards what follows
  bus_t health_{};
  DurationHistogram handover_;
  std::set<std::string> told_;  // reasons of this outage
  bool finished_ = false;
  bool gone_ = false;

  std::thread thread_;
};

}  // namespace bole
