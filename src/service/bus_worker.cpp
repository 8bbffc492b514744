#include "service/bus_worker.h"

#include <algorithm>
#include <bit>
#include <utility>

#include <spdlog/spdlog.h>

#include "base/clock.h"
#include "publish/encoder.h"

namespace bole {
namespace {

constexpr std::size_t slot_of(MessageKind kind) { return static_cast<std::size_t>(kind); }

std::size_t handover_bin(std::int64_t ns) {
  const auto us = static_cast<std::uint64_t>(std::max<std::int64_t>(ns, 0) / 1000);
  return std::min<std::size_t>(std::bit_width(us), bus_t::HANDOVER_BINS - 1);
}

float us(std::int64_t ns) { return static_cast<float>(ns) / 1000; }

}  // namespace

BusWorker::BusWorker(std::unique_ptr<Publisher> publisher, WhenFull when_full,
                     std::shared_ptr<Doorbell> bell, std::function<void()> on_finished,
                     Trace* trace)
    : publisher_(std::move(publisher)),
      when_full_(when_full),
      on_finished_(std::move(on_finished)),
      trace_(trace),
      mailbox_(std::move(bell)) {
  health_.name = publisher_->name();
  health_.healthy = 1;
  thread_ = std::thread([this] { run(); });
}

BusWorker::~BusWorker() {
  close();
  thread_.join();
}

void BusWorker::offer(MessageKind kind, std::span<const std::byte> bytes, std::string_view file,
                      std::int64_t processed_ns, std::int64_t seq) {
  if (!publisher_->carries(kind)) return;
  Message& message = outgoing_.at(slot_of(kind));
  message.bytes.reserve(kDatagramBytes);  // of each buffer that goes round, once
  message.bytes.assign(bytes.begin(), bytes.end());
  message.file.assign(file);
  message.processed_ns = processed_ns;
  message.seq = seq;
  const WhenFull when_full = kind == MessageKind::trees ? when_full_ : WhenFull::overwrite;
  if (mailbox_.lay(message, when_full, slot_of(kind)) && kind == MessageKind::trees) {
    const std::lock_guard lock(mutex_);
    ++health_.overwritten;
  }
}

void BusWorker::run() {
  Message message;
  while (const auto slot = mailbox_.take(message)) {
    publish(static_cast<MessageKind>(*slot), message);
  }
  {
    const std::lock_guard lock(mutex_);
    finished_ = true;
  }
  on_finished_();
}

void BusWorker::publish(MessageKind kind, const Message& message) {
  try {
    publisher_->publish(kind, message.bytes, message.file);
    const std::int64_t done_ns = SystemClock().mono_ns();
    record_success(kind, done_ns - message.processed_ns);
    if (trace_ != nullptr && kind == MessageKind::trees) {
      trace_->record("hand over", Trace::Lane::bus, message.seq, message.processed_ns, done_ns);
    }
  } catch (const BusGone& error) {
    record_failure(kind, error.what());
    record_gone();
  } catch (const std::exception& error) {
    record_failure(kind, error.what());
  }
}

void BusWorker::record_success(MessageKind kind, std::int64_t handover_ns) {
  const std::lock_guard lock(mutex_);
  if (!told_.empty()) spdlog::info("{}: publishing again", health_.name);
  told_.clear();
  health_.healthy = 1;
  if (kind != MessageKind::trees) return;
  ++health_.published;
  ++health_.handover_histogram[handover_bin(handover_ns)];
  handover_.add(handover_ns);
}

void BusWorker::record_failure(MessageKind kind, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  if (told_.insert(reason).second) {
    spdlog::error("{}: {} (tried again with every message)", health_.name, reason);
  }
  health_.healthy = 0;
  health_.last_error = reason;
  if (kind == MessageKind::trees) ++health_.failed;
}

void BusWorker::record_gone() {
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(gone_, true)) return;
  }
  on_finished_();
}

bool BusWorker::gone() const {
  const std::lock_guard lock(mutex_);
  return gone_;
}

bool BusWorker::finished() const {
  const std::lock_guard lock(mutex_);
  return finished_;
}

bus_t BusWorker::health() const {
  const std::lock_guard lock(mutex_);
  bus_t health = health_;
  health.handover_p50_us = us(handover_.quantile(0.5));
  health.handover_p99_us = us(handover_.quantile(0.99));
  health.handover_max_us = us(handover_.max());
  return health;
}

}  // namespace bole
