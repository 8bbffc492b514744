#pragma once

#include <signal.h>

#include "base/files.h"

namespace bole {

/// SIGINT and SIGTERM as a descriptor that becomes readable when one has come, in place of their
/// default action. To be made before any other thread, so that all inherit the mask. SIGPIPE is
/// ignored from then on: a reader that has gone is an error of the write.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// For poll().
  int fd() const { return fd_.get(); }

 private:
  sigset_t before_{};
  UniqueFd fd_;
};

}  // namespace bole
