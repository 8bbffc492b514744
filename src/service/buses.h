#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "base/clock.h"
#include "bole/status_t.hpp"
#include "service/bus_worker.h"

namespace bole {

/// The buses of a daemon. A message goes to all of them, and one call wakes all their threads.
class Buses {
 public:
  /// As BusWorker has them.
  Buses(std::vector<std::unique_ptr<Publisher>> publishers, WhenFull when_full,
        const std::function<void()>& on_finished, Trace* trace = nullptr);
  /// What is in the slots is published before this returns.
  ~Buses() { close(); }
  Buses(const Buses&) = delete;
  Buses& operator=(const Buses&) = delete;

  /// As BusWorker::offer().
  void offer(MessageKind kind, std::span<const std::byte> bytes, std::string_view file,
             std::int64_t processed_ns, std::int64_t seq = 0);
  /// Completes `status` with what `clock` reads and how each bus does, and offers it.
  void offer(status_t status, const Clock& clock);
  void close();
  void interrupt() noexcept;
  bool finished() const;
  /// All are gone, and there are any: nobody will hear us again.
  bool gone() const;

  /// Of each bus, in the order of the publishers.
  std::vector<bus_t> health() const;

 private:
  std::vector<std::byte> status_bytes_;
  const std::shared_ptr<Doorbell> bell_ = std::make_shared<Doorbell>();
  std::vector<std::unique_ptr<BusWorker>> workers_;
};

}  // namespace bole
