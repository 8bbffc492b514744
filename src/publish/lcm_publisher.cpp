#include "publish/lcm_publisher.h"

#include <cerrno>

#include "base/errors.h"

namespace bole {

void LcmPublisher::connect() {
  // Asked first because lcm_create prints a page of advice of its own at each failure.
  const std::string problem = missing_route(url_);
  if (!problem.empty()) throw BusError(problem);
  lcm_.reset(lcm_create(url_.text().c_str()));
  if (!lcm_) throw BusError("cannot open " + url_.text());
}

void LcmPublisher::publish(MessageKind kind, std::span<const std::byte> bytes,
                           const std::string& /*file*/) {
  if (!lcm_) connect();
  const char* channel = kind == MessageKind::trees ? kTreesChannel : kStatusChannel;
  errno = 0;
  if (lcm_publish(lcm_.get(), channel, bytes.data(), static_cast<unsigned>(bytes.size())) != 0) {
    const int error = errno;
    lcm_.reset();
    throw BusError("cannot send to " + url_.text() + ": " + error_text(error));
  }
}

}  // namespace bole
