#include "publish/zenoh_publisher.h"

#include <spdlog/spdlog.h>

namespace bole {
namespace {

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

void ZenohPublisher::publish(MessageKind kind, std::span<const std::byte> bytes,
                             const std::string& /*file*/) {
  if (kind == MessageKind::status) {
    for (const ZenohWarning& warning : ZenohSession::take_warnings()) {
      spdlog::warn("zenoh: {} ({} times)", warning.text, warning.count);
    }
  }
  const ZenohTopic topic = kind == MessageKind::trees ? ZenohTopic::trees : ZenohTopic::status;
  const bool open = session_.put(topic, bytes);
  if (open && !connects_) return;
  const ZenohState state = session_.state();
  if (!open) throw BusError(state.error.empty() ? "is still opening" : state.error);
  if (!state.connected()) throw BusError("nobody answers at the endpoints to connect to");
}

}  // namespace bole
