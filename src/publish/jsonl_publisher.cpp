#include "publish/jsonl_publisher.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>
#include <system_error>

#include "base/errors.h"
#include "publish/decoder.h"
#include "publish/json_line.h"

namespace bole {
namespace {

std::string reason(int error) { return std::generic_category().message(error); }

void wait_until_writable(int fd) {
  pollfd entry{fd, POLLOUT, 0};
  ::poll(&entry, 1, -1);
}

void write_all(int fd, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(fd, text.data(), text.size());
    if (written < 0 && errno == EAGAIN) {
      wait_until_writable(fd);
    } else if (written < 0 && errno != EINTR) {
      throw BusError("cannot be written: " + reason(errno));
    }
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace

JsonlPublisher::JsonlPublisher(const std::filesystem::path& target)
    : fd_(target == "-" ? ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3)
                        : ::open(target.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)) {
  if (!fd_) {
    throw ConfigError("publish", "jsonl:" + target.string(), "cannot be written: " + reason(errno),
                      "give a path that may be written to, or - for standard output");
  }
}

void JsonlPublisher::publish(MessageKind kind, std::span<const std::byte> bytes,
                             const std::string& file) {
  if (kind != MessageKind::trees) return;
  write_json_line(decode_tree_list(bytes), file, line_);
  write_all(fd_.get(), line_);
}

}  // namespace bole
