#pragma once

#include <cstdint>
#include <string>

namespace bole {

/// Where LCM's datagrams go.
struct LcmUrl {
  std::string address;  ///< IPv4 multicast, dotted
  std::uint16_t port = 7667;
  int ttl = 0;  ///< routers that a datagram may pass; 0 = it stays on this machine

  std::string text() const;
};

/// Stays on this machine: reaching the network is an explicit ttl=1.
inline const std::string kDefaultLcmUrl = "udpm://239.255.76.67:7667?ttl=0";

/// Parses "udpm://ADDRESS:PORT?ttl=N"; ttl may be left out and is then 0. Throws ConfigError naming
/// `origin` (a file or an option) and `key`.
LcmUrl parse_lcm_url(const std::string& url, const std::string& origin, const std::string& key);

/// Why datagrams to `url` would not leave: "no multicast route ...", with the command that mends
/// it; empty when they would.
std::string missing_route(const LcmUrl& url);

}  // namespace bole
