#include "base/wakeup.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <system_error>

namespace bole {

Wakeup::Wakeup() : event_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (!event_) throw std::system_error(errno, std::generic_category(), "eventfd");
}

void Wakeup::raise() const noexcept {
  const std::uint64_t one = 1;
  // Fails only when the flag has been raised 2^64 - 2 times: it is up.
  [[maybe_unused]] const ssize_t written = ::write(event_.get(), &one, sizeof one);
}

bool Wakeup::take() const noexcept {
  std::uint64_t count = 0;
  return ::read(event_.get(), &count, sizeof count) == sizeof count;
}

bool Wakeup::wait(std::int64_t timeout_ns) const noexcept {
  constexpr std::int64_t kSecond = 1'000'000'000;
  timeout_ns = std::max<std::int64_t>(timeout_ns, 0);
  const timespec timeout{timeout_ns / kSecond, timeout_ns % kSecond};
  pollfd event{event_.get(), POLLIN, 0};
  return ::ppoll(&event, 1, &timeout, nullptr) == 1;
}

}  // namespace bole
