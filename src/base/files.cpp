#include "base/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "base/errors.h"

namespace bole {
namespace {

struct OpenedFile {
  UniqueFd fd;
  std::size_t size;
};

OpenedFile open_regular(const std::filesystem::path& path) {
  // O_NONBLOCK: a FIFO of that name must not hang the start.
  UniqueFd fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!fd) {
    throw ConfigError(path, "", "cannot be read: " + error_text(errno),
                      "give the path of a readable file");
  }
  struct stat info {};
  if (::fstat(fd.get(), &info) != 0 || !S_ISREG(info.st_mode)) {
    throw ConfigError(path, "", "is not a regular file", "give the path of a readable file");
  }
  return {std::move(fd), static_cast<std::size_t>(info.st_size)};
}

void write_all(const UniqueFd& fd, std::span<const std::byte> bytes,
               const std::filesystem::path& path) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd.get(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      throw ConfigError(path, "", "cannot be written: " + error_text(errno),
                        "free space or permission");
    }
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void sync_folder(const std::filesystem::path& folder) {
  const UniqueFd fd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (fd) ::fsync(fd.get());
}

// Removes the half-written file unless the rename was reached.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::filesystem::path& target)
      : name_(target.string() + ".XXXXXX"), fd_(::mkostemp(name_.data(), O_CLOEXEC)) {
    if (!fd_) {
      throw ConfigError(target, "", "cannot be written: " + error_text(errno),
                        "give a folder that may be written to");
    }
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (!name_.empty()) ::unlink(name_.c_str());
  }

  const UniqueFd& fd() const { return fd_; }
  bool rename_to(const std::filesystem::path& target) {
    if (::fchmod(fd_.get(), 0644) != 0 || ::fsync(fd_.get()) != 0 ||
        ::rename(name_.c_str(), target.c_str()) != 0) {
      return false;
    }
    name_.clear();
    return true;
  }

 private:
  std::string name_;
  UniqueFd fd_;
};

// What `path` leads to through links. A rename would put a file in the place of a device or a pipe.
std::filesystem::path file_to_replace(const std::filesystem::path& path) {
  std::error_code error;  // what is not to be seen is told by mkostemp
  const auto kind = std::filesystem::symlink_status(path, error);
  if (!std::filesystem::exists(kind)) return path;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw ConfigError(path, "", "is not a regular file", "give the path of a file, or a new one");
  }
  return std::filesystem::is_symlink(kind) ? std::filesystem::canonical(path, error) : path;
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error) return;
  throw ConfigError(folder, "", "cannot be made: " + error.message(),
                    "give a folder that may be written to");
}

}  // namespace

UniqueFd::~UniqueFd() {
  if (fd_ >= 0) ::close(fd_);
}

std::vector<std::byte> read_file(const std::filesystem::path& path, std::size_t max_bytes) {
  std::vector<std::byte> bytes;
  read_file(path, max_bytes, bytes);
  return bytes;
}

void read_file(const std::filesystem::path& path, std::size_t max_bytes,
               std::vector<std::byte>& bytes) {
  const OpenedFile file = open_regular(path);
  if (file.size > max_bytes) {
    throw ConfigError(path, "", "has " + std::to_string(file.size) + " bytes",
                      "at most " + std::to_string(max_bytes) + " are read");
  }
  bytes.resize(file.size);
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const ssize_t got = ::read(file.fd.get(), bytes.data() + filled, bytes.size() - filled);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw ConfigError(path, "", "cannot be read: " + error_text(errno), "");
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
  }
  bytes.resize(filled);
}

std::string read_text_file(const std::filesystem::path& path, std::size_t max_bytes) {
  const std::vector<std::byte> bytes = read_file(path, max_bytes);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  const std::filesystem::path target = file_to_replace(path);
  const std::filesystem::path folder = target.has_parent_path() ? target.parent_path() : ".";
  make_folder(folder);
  TemporaryFile temporary(target);
  write_all(temporary.fd(), bytes, target);
  if (!temporary.rename_to(target)) {
    throw ConfigError(target, "", "cannot be replaced: " + error_text(errno), "");
  }
  sync_folder(folder);
}

void check_replaceable(const std::filesystem::path& path) {
  const std::filesystem::path target = std::filesystem::absolute(file_to_replace(path));
  std::filesystem::path folder = target.parent_path();
  std::error_code error;
  while (!std::filesystem::exists(folder, error) && folder.has_relative_path()) {
    folder = folder.parent_path();
  }
  const TemporaryFile probe(folder / target.filename());
}

}  // namespace bole
