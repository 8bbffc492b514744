#include "publish/jsonl_publisher.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <fstream>
#include <system_error>

#include "base/errors.h"
#include "publish/decoder.h"
#include "publish/json_line.h"

namespace bole {
namespace {

int open_for_lines(const std::filesystem::path& target, JsonlPublisher::Earlier earlier) {
  if (target == "-") return ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
  const int emptied = earlier == JsonlPublisher::Earlier::erased ? O_TRUNC : 0;
  // Not to wait for a pipe's reader, whom nobody could interrupt.
  constexpr int kFlags = O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC | O_NONBLOCK;
  return ::open(target.c_str(), kFlags | emptied, 0644);
}

UniqueFd open_target(const std::filesystem::path& target, JsonlPublisher::Earlier earlier,
                     const std::string& origin) {
  UniqueFd fd(open_for_lines(target, earlier));
  if (fd) return fd;
  throw ConfigError(origin, "publish.to",
                    "jsonl:" + target.string() + " cannot be written: " + error_text(errno),
                    "give a path that may be written to, or - for standard output");
}

// A daemon before us may have been cut off in the middle of a line.
bool ends_within_a_line(const std::filesystem::path& target) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(target, error)) return false;
  std::ifstream file(target, std::ios::binary);
  return file.seekg(-1, std::ios::end) && file.get() != '\n';
}

}  // namespace

JsonlPublisher::JsonlPublisher(const std::filesystem::path& target, Earlier earlier,
                               const std::string& origin)
    : fd_(open_target(target, earlier, origin)),
      to_stdout_(target == "-"),
      torn_(ends_within_a_line(target)) {}

void JsonlPublisher::publish(MessageKind /*kind*/, std::span<const std::byte> bytes,
                             const std::string& file) {
  if (torn_) write_all("\n");
  write_json_line(decode_tree_list(bytes), file, line_);
  write_all(line_);
}

// A pipe that polls as writable takes PIPE_BUF bytes at once: a reader that has stopped reading can
// so never keep us from being interrupted.
void JsonlPublisher::write_all(std::string_view text) {
  while (!text.empty()) {
    std::array<pollfd, 2> waits{pollfd{fd_.get(), POLLOUT, 0},
                                pollfd{interrupted_.fd(), POLLIN, 0}};
    ::poll(waits.data(), waits.size(), -1);
    if (waits[1].revents != 0) throw BusError("was interrupted: its reader does not read");
    const ssize_t written =
        ::write(fd_.get(), text.data(), std::min<std::size_t>(text.size(), PIPE_BUF));
    if (written < 0 && errno != EINTR && errno != EAGAIN) {
      const std::string why = "cannot be written: " + error_text(errno);
      if (errno == EPIPE && to_stdout_) throw BusGone(why);
      throw BusError(why);
    }
    if (written <= 0) continue;
    text.remove_prefix(static_cast<std::size_t>(written));
    torn_ = !text.empty();
  }
}

}  // namespace bole
