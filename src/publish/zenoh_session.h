#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace bole {

/// Where a session listens that is told of no endpoint at all (zenoh_bridge/src/config.rs).
inline constexpr const char* kDefaultZenohEndpoint = "tcp/127.0.0.1:7447";

/// The `zenoh` table of the configuration. What is empty or absent is left to the file that
/// `config_file` names, then to the defaults: no endpoint at all, a peer that listens on
/// kDefaultZenohEndpoint; endpoints to connect to only, a client; else a peer. Zenoh's routers
/// carry data to and from clients, but not from peer to peer: peers must reach each other
/// themselves.
struct ZenohConfig {
  std::string file;                  // where these settings stand, for messages only
  std::string mode;                  // peer, client or router
  std::vector<std::string> listen;   // tcp/HOST:PORT or tls/HOST:PORT
  std::vector<std::string> connect;  // likewise; a client stays with the first that answers
  std::optional<bool> multicast_scouting;
  struct Tls {
    std::string ca;  // PEM files; the others' certificates are checked against this one
    std::string certificate;
    std::string private_key;
    std::optional<bool> mutual;  // whoever connects needs a certificate too
  } tls;
  std::string config_file;  // a whole Zenoh configuration in JSON5
};

/// Whose keys these are: bole/<robot>/<camera>/...
struct ZenohIdentity {
  std::string robot;
  std::string camera;
};

/// What a daemon offers below its identity. Each answers queries with the last bytes given; the
/// first two are also published.
enum class ZenohTopic { trees, status, config, calibration };

struct ZenohState {
  bool open = false;          // false while the session waits for its port or (a client) its router
  int routers = 0;            // links to routers
  int peers = 0;              // links to peers and clients
  std::uint64_t changes = 0;  // links that came or went since the start
  std::string error;          // why it does not open
  std::uint64_t overrun = 0;  // received messages that receive() was too slow for

  bool connected() const { return routers + peers > 0; }
};

struct ZenohMessage {
  enum class Event { sample, alive, gone };  // alive, gone: the liveliness token `key`
  Event event = Event::sample;
  std::string key;
  std::string encoding;
  std::vector<std::byte> payload;
};

/// Something zenoh warned of, as a refused certificate, and how often.
struct ZenohWarning {
  std::string text;
  std::uint64_t count = 0;
};

/// Throws ConfigError for settings that cannot work, as ZenohSession does, and touches no network.
void check_zenoh(const ZenohConfig& config);

/// A Zenoh session that opens in the background and finds its way back after every outage. It may
/// be used by several threads. Ignore SIGPIPE in a program that uses it.
class ZenohSession {
 public:
  /// Publishes and answers as `identity` and holds its liveliness token bole/<robot>/<camera>/alive
  /// (none: offers nothing); receives what matches the key expressions `subscribe`. Throws
  /// ConfigError for settings that cannot work (malformed endpoint, unreadable or unfit
  /// certificate); what may mend itself, as a port in use, is tried again and shown in state().
  explicit ZenohSession(const ZenohConfig& config,
                        const std::optional<ZenohIdentity>& identity = std::nullopt,
                        const std::vector<std::string>& subscribe = {});
  ZenohSession(ZenohSession&&) noexcept;
  ZenohSession& operator=(ZenohSession&&) noexcept;
  ZenohSession(const ZenohSession&) = delete;
  ZenohSession& operator=(const ZenohSession&) = delete;
  /// Takes leave of the others; up to half a second when a link is stuck.
  ~ZenohSession();

  /// Publishes `payload` on the topic (trees or status) and keeps it as the answer to queries.
  /// Never waits for a link: one that is full drops it. False while the session is not open.
  /// Throws BusError.
  bool put(ZenohTopic topic, std::span<const std::byte> payload);

  /// Sets what queries for `topic` are answered with.
  void set_answer(ZenohTopic topic, std::span<const std::byte> payload,
                  const std::string& encoding);

  ZenohState state() const;

  /// Received since the last call, in order; waits up to `timeout` for the first one.
  std::vector<ZenohMessage> receive(std::chrono::milliseconds timeout);

  /// One line for each setting in which `config` overrode its config_file.
  std::vector<std::string> overridden() const;

  /// What zenoh warned of since the last call, in any session of this process.
  static std::vector<ZenohWarning> take_warnings();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bole
