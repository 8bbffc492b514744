#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace bole {

/// Owns a file descriptor and closes it.
class UniqueFd {
 public:
  UniqueFd() = default;
  explicit UniqueFd(int fd) : fd_(fd) {}
  UniqueFd(UniqueFd&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  UniqueFd& operator=(UniqueFd&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  UniqueFd(const UniqueFd&) = delete;
  UniqueFd& operator=(const UniqueFd&) = delete;
  ~UniqueFd();

  int get() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }
  void reset() { *this = UniqueFd(); }

 private:
  int fd_ = -1;
};

/// The bytes of a regular file. Throws ConfigError when it is missing, unreadable, not a regular
/// file or larger than `max_bytes`.
std::vector<std::byte> read_file(const std::filesystem::path& path, std::size_t max_bytes);

/// As above, into `bytes`, whose memory is used again.
void read_file(const std::filesystem::path& path, std::size_t max_bytes,
               std::vector<std::byte>& bytes);

/// As read_file, as text.
std::string read_text_file(const std::filesystem::path& path, std::size_t max_bytes);

/// Replaces `path` by `bytes` in one step: whoever reads it sees the old file or the whole new one,
/// also after a power cut. Missing folders are made; links are followed. Throws ConfigError when it
/// cannot, and when what is there is no regular file.
void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// Throws ConfigError where write_file_atomically could not begin. Leaves nothing behind.
void check_replaceable(const std::filesystem::path& path);

}  // namespace bole
