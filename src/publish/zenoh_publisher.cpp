#include "publish/zenoh_publisher.h"

#include <chrono>
#include <thread>
#include <utility>

#include <spdlog/spdlog.h>

namespace bole {
namespace {

using std::chrono::steady_clock;

constexpr std::chrono::seconds kOpeningPatience{1};
constexpr std::size_t kMostWarnings = 64;  // told apart

bool is_power_of_ten(std::uint64_t number) {
  while (number > 1 && number % 10 == 0) number /= 10;
  return number == 1;
}

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

}  // namespace

ZenohPublisher::ZenohPublisher(const ZenohConfig& config, const ZenohIdentity& identity,
                               const ZenohAnswers& answers)
    : session_(config, identity), connects_(!config.connect.empty()) {
  for (const std::string& line : session_.overridden()) spdlog::info("zenoh: {}", line);
  session_.set_answer(ZenohTopic::config, bytes_of(answers.configuration), "application/toml");
  session_.set_answer(ZenohTopic::calibration, bytes_of(answers.calibration), "application/json");
}

std::string ZenohPublisher::trouble() const {
  const ZenohState state = session_.state();
  if (!state.open) return state.error.empty() ? "is still opening" : state.error;
  if (connects_ && !state.connected()) return "nobody answers at the endpoints to connect to";
  return {};
}

void ZenohPublisher::await_opening() const {
  const auto end = steady_clock::now() + kOpeningPatience;
  while (!trouble().empty() && steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

void ZenohPublisher::log_warnings() {
  for (const ZenohWarning& warning : ZenohSession::take_warnings()) {
    if (warned_.size() == kMostWarnings && !warned_.contains(warning.text)) warned_.clear();
    std::uint64_t& count = warned_[warning.text];
    for (std::uint64_t more = warning.count; more > 0; --more) {
      if (!is_power_of_ten(++count)) continue;
      spdlog::warn("zenoh: {}{}", warning.text,
                   count > 1 ? " (" + std::to_string(count) + " times)" : "");
    }
  }
}

void ZenohPublisher::publish(MessageKind kind, std::span<const std::byte> bytes,
                             const std::string& /*file*/) {
  if (!std::exchange(awaited_, true)) await_opening();
  if (kind == MessageKind::status) log_warnings();
  session_.put(kind == MessageKind::trees ? ZenohTopic::trees : ZenohTopic::status, bytes);
  const std::string problem = trouble();
  if (!problem.empty()) throw BusError(problem);
}

}  // namespace bole
