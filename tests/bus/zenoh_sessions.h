// What the tests of Zenoh sessions share: real sessions on 127.0.0.1.
#pragma once

#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <chrono>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/files.h"
#include "publish/zenoh_session.h"

namespace bole::test {

inline const ZenohIdentity identity{.robot = "harvester", .camera = "top"};
inline const std::string prefix = "bole/harvester/top/";

// A port that nothing listens on; open() sets SO_REUSEADDR, so that it can be taken at once.
inline UniqueFd bind_to_free_port(int& port) {
  UniqueFd fd(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  EXPECT_EQ(bind(fd.get(), reinterpret_cast<sockaddr*>(&address), size), 0);
  EXPECT_EQ(getsockname(fd.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
  port = ntohs(address.sin_port);
  return fd;
}

inline std::string free_endpoint(const std::string& protocol = "tcp") {
  int port = 0;
  bind_to_free_port(port);
  return protocol + "/127.0.0.1:" + std::to_string(port);
}

inline ZenohConfig listening(const std::string& endpoint, const std::string& mode = "peer") {
  ZenohConfig config;
  config.file = "boled.toml";
  config.mode = mode;
  config.listen = {endpoint};
  return config;
}

inline ZenohConfig connecting(const std::string& endpoint, const std::string& mode = "peer") {
  ZenohConfig config;
  config.file = "boled.toml";
  config.mode = mode;
  config.connect = {endpoint};
  return config;
}

inline bool eventually(const std::function<bool()>& condition,
                       std::chrono::milliseconds limit = std::chrono::seconds(10)) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

inline std::vector<std::byte> bytes_of(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

// Takes messages until one is as wanted.
inline std::optional<ZenohMessage> await(
    ZenohSession& session, ZenohMessage::Event event, const std::string& key,
    std::chrono::milliseconds limit = std::chrono::seconds(10)) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (std::chrono::steady_clock::now() < end) {
    for (auto& message : session.receive(std::chrono::milliseconds(50))) {
      if (message.event == event && message.key == key) return std::move(message);
    }
  }
  return std::nullopt;
}

// Publishes until the subscriber gets something: how long that took.
inline std::optional<std::chrono::milliseconds> time_to_delivery(ZenohSession& daemon,
                                                                 ZenohSession& subscriber) {
  const auto start = std::chrono::steady_clock::now();
  subscriber.receive(std::chrono::milliseconds(0));
  while (std::chrono::steady_clock::now() < start + std::chrono::seconds(10)) {
    daemon.put(ZenohTopic::trees, bytes_of("list"));
    if (await(subscriber, ZenohMessage::Event::sample, prefix + "trees",
              std::chrono::milliseconds(100))) {
      return std::chrono::duration_cast<std::chrono::milliseconds>(
          std::chrono::steady_clock::now() - start);
    }
  }
  return std::nullopt;
}

}  // namespace bole::test
