#include "publish/lcm_url.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <regex>

#include "base/errors.h"
#include "base/files.h"

namespace bole {
namespace {

bool is_multicast(const std::string& address) {
  in_addr parsed{};
  return ::inet_pton(AF_INET, address.c_str(), &parsed) == 1 && IN_MULTICAST(ntohl(parsed.s_addr));
}

}  // namespace

std::string LcmUrl::text() const {
  return "udpm://" + address + ":" + std::to_string(port) + "?ttl=" + std::to_string(ttl);
}

LcmUrl parse_lcm_url(const std::string& url, const std::string& origin, const std::string& key) {
  static const std::regex form(R"(udpm://([0-9.]+):([0-9]{1,5})(?:\?ttl=([0-9]{1,3}))?)");
  std::smatch part;
  if (!std::regex_match(url, part, form)) {
    throw ConfigError(origin, key, "is \"" + url + "\"", "write it as " + kDefaultLcmUrl);
  }
  const int port = std::stoi(part[2]);
  const int ttl = part[3].matched ? std::stoi(part[3]) : 0;
  if (!is_multicast(part[1])) {
    throw ConfigError(origin, key, "has the address " + part[1].str(),
                      "must be from 224.0.0.0 to 239.255.255.255");
  }
  if (port < 1 || port > 65535) {
    throw ConfigError(origin, key, "has the port " + part[2].str(), "must be from 1 to 65535");
  }
  if (ttl > 255) {
    throw ConfigError(origin, key, "has the ttl " + part[3].str(), "must be from 0 to 255");
  }
  return {part[1], static_cast<std::uint16_t>(port), ttl};
}

std::string missing_route(const LcmUrl& url) {
  const UniqueFd probe(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in target{};
  target.sin_family = AF_INET;
  target.sin_port = htons(url.port);
  ::inet_pton(AF_INET, url.address.c_str(), &target.sin_addr);
  // Connecting a datagram socket sends nothing; it only asks the kernel for the way.
  if (probe &&
      ::connect(probe.get(), reinterpret_cast<const sockaddr*>(&target), sizeof target) == 0) {
    return {};
  }
  if (errno == ENETUNREACH) {
    return "no multicast route to " + url.address + "; ip route add 224.0.0.0/4 dev lo";
  }
  return url.address + " cannot be reached: " + error_text(errno);
}

}  // namespace bole
