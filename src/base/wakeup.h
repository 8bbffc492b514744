#pragma once

#include <cstdint>

#include "base/files.h"

namespace bole {

/// A flag that another thread (or a signal handler) raises and that poll() can wait for.
class Wakeup {
 public:
  /// Throws std::system_error when the process has no descriptor left.
  Wakeup();

  void raise() const noexcept;
  /// Lowers the flag; true when it was raised.
  bool take() const noexcept;
  /// Waits at most `timeout_ns` (0: only looks) for the flag and leaves it as it is.
  bool wait(std::int64_t timeout_ns) const noexcept;
  /// Readable while the flag is raised.
  int fd() const { return event_.get(); }

 private:
  UniqueFd event_;
};

}  // namespace bole
