#include "service/buses.h"

#include <algorithm>
#include <utility>

#include "publish/encoder.h"

namespace bole {

Buses::Buses(std::vector<std::unique_ptr<Publisher>> publishers, WhenFull when_full,
             const std::function<void()>& on_finished, Trace* trace) {
  for (auto& publisher : publishers) {
    workers_.push_back(
        std::make_unique<BusWorker>(std::move(publisher), when_full, bell_, on_finished, trace));
  }
}

void Buses::offer(MessageKind kind, std::span<const std::byte> bytes, std::string_view file,
                  std::int64_t processed_ns, std::int64_t seq) {
  for (const auto& worker : workers_) worker->offer(kind, bytes, file, processed_ns, seq);
  bell_->ring();
}

void Buses::offer(status_t status, const Clock& clock) {
  status.utime = clock.utc_us();
  status.mono_ns = clock.mono_ns();
  status.buses = health();
  encode_status(std::move(status), status_bytes_);
  offer(MessageKind::status, status_bytes_, "", SystemClock().mono_ns());
}

void Buses::close() {
  for (const auto& worker : workers_) worker->close();
}

void Buses::interrupt() noexcept {
  for (const auto& worker : workers_) worker->interrupt();
}

bool Buses::finished() const {
  return std::ranges::all_of(workers_, [](const auto& worker) { return worker->finished(); });
}

bool Buses::gone() const {
  return !workers_.empty() &&
         std::ranges::all_of(workers_, [](const auto& worker) { return worker->gone(); });
}

std::vector<bus_t> Buses::health() const {
  std::vector<bus_t> health;
  for (const auto& worker : workers_) health.push_back(worker->health());
  return health;
}

}  // namespace bole
