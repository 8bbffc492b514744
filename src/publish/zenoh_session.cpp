#include "publish/zenoh_session.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <rust/cxx.h>

#include "base/errors.h"
#include "publish/publisher.h"
#include "zenoh_bridge/src/lib.rs.h"

namespace bole {
namespace {

namespace bridge = zenoh_bridge;

struct TopicTraits {
  const char* name;
  const char* encoding;   // of what is published
  std::uint8_t priority;  // 1 (real time) .. 7 (background); 0: answers queries only
};

// In the order of ZenohTopic. Trees go before all else that shares the link.
constexpr std::array<TopicTraits, 4> topics = {{
    {"trees", "application/octet-stream;bole.tree_list_t", 2},
    {"status", "application/octet-stream;bole.status_t", 4},
    {"config", "", 0},
    {"calibration", "", 0},
}};

rust::Vec<rust::String> to_rust(const std::vector<std::string>& texts) {
  rust::Vec<rust::String> list;
  std::ranges::copy(texts, std::back_inserter(list));
  return list;
}

bridge::Switch to_rust(std::optional<bool> value) {
  if (!value) return bridge::Switch::Unset;
  return *value ? bridge::Switch::On : bridge::Switch::Off;
}

rust::Slice<const std::uint8_t> to_rust(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

bridge::Settings to_rust(const ZenohConfig& config, const std::optional<ZenohIdentity>& identity,
                         const std::vector<std::string>& subscribe) {
  bridge::Settings settings;
  settings.mode = config.mode;
  settings.listen = to_rust(config.listen);
  settings.connect = to_rust(config.connect);
  settings.multicast_scouting = to_rust(config.multicast_scouting);
  settings.tls_ca = config.tls.ca;
  settings.tls_certificate = config.tls.certificate;
  settings.tls_private_key = config.tls.private_key;
  settings.tls_mutual = to_rust(config.tls.mutual);
  settings.config_file = config.config_file;
  settings.subscribe = to_rust(subscribe);
  if (identity) {
    const std::string prefix = "bole/" + identity->robot + "/" + identity->camera + "/";
    for (const auto& topic : topics) {
      settings.topics.push_back({prefix + topic.name, topic.encoding, topic.priority});
    }
    settings.alive_key = prefix + "alive";
  }
  return settings;
}

ZenohMessage from_rust(const bridge::Message& message) {
  using Event = ZenohMessage::Event;
  const auto bytes = std::as_bytes(std::span(message.payload.data(), message.payload.size()));
  return {.event = message.event == bridge::Event::Sample  ? Event::sample
                   : message.event == bridge::Event::Alive ? Event::alive
                                                           : Event::gone,
          .key = std::string(message.key),
          .encoding = std::string(message.encoding),
          .payload = {bytes.begin(), bytes.end()}};
}

// Errors of the bridge become ours.
auto translated(auto&& call) -> decltype(call()) {
  try {
    return call();
  } catch (const rust::Error& error) {
    throw BusError(std::string("zenoh: ") + error.what());
  }
}

// `call`: of the bridge, with the problem that it may leave.
auto configured(const ZenohConfig& config, auto&& call) {
  bridge::Problem problem;
  try {
    return call(problem);
  } catch (const rust::Error& error) {
    if (problem.problem.empty()) throw BusError(std::string("zenoh: ") + error.what());
    throw ConfigError(config.file, std::string(problem.key), std::string(problem.problem),
                      std::string(problem.remedy));
  }
}

}  // namespace

void check_zenoh(const ZenohConfig& config) {
  configured(config, [&](bridge::Problem& problem) {
    bridge::check(to_rust(config, std::nullopt, {}), problem);
  });
}

struct ZenohSession::Impl {
  rust::Box<bridge::Session> session;
};

ZenohSession::ZenohSession(const ZenohConfig& config, const std::optional<ZenohIdentity>& identity,
                           const std::vector<std::string>& subscribe)
    : impl_(std::make_unique<Impl>(Impl{configured(config, [&](bridge::Problem& problem) {
        return bridge::open(to_rust(config, identity, subscribe), problem);
      })})) {}

ZenohSession::ZenohSession(ZenohSession&&) noexcept = default;
ZenohSession& ZenohSession::operator=(ZenohSession&&) noexcept = default;
ZenohSession::~ZenohSession() = default;

bool ZenohSession::put(ZenohTopic topic, std::span<const std::byte> payload) {
  return translated(
      [&] { return impl_->session->put(static_cast<std::size_t>(topic), to_rust(payload)); });
}

void ZenohSession::set_answer(ZenohTopic topic, std::span<const std::byte> payload,
                              const std::string& encoding) {
  translated([&] {
    impl_->session->set_answer(static_cast<std::size_t>(topic), encoding, to_rust(payload));
  });
}

ZenohState ZenohSession::state() const {
  const auto state = translated([&] { return impl_->session->state(); });
  return {.open = state.open,
          .routers = static_cast<int>(state.routers),
          .peers = static_cast<int>(state.peers),
          .changes = state.changes,
          .error = std::string(state.error),
          .overrun = state.overrun};
}

std::vector<ZenohMessage> ZenohSession::receive(std::chrono::milliseconds timeout) {
  const auto received = translated(
      [&] { return impl_->session->receive(static_cast<std::uint32_t>(timeout.count())); });
  std::vector<ZenohMessage> messages;
  std::ranges::transform(received, std::back_inserter(messages), from_rust);
  return messages;
}

std::vector<std::string> ZenohSession::overridden() const {
  std::vector<std::string> lines;
  for (const auto& line : impl_->session->overridden()) lines.emplace_back(line);
  return lines;
}

std::vector<ZenohWarning> ZenohSession::take_warnings() {
  std::vector<ZenohWarning> warnings;
  for (const auto& warning : translated([] { return bridge::take_warnings(); })) {
    warnings.push_back({std::string(warning.text), warning.count});
  }
  return warnings;
}

}  // namespace bole
