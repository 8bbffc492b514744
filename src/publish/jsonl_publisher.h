#pragma once

#include <filesystem>
#include <string_view>

#include "base/files.h"
#include "base/wakeup.h"
#include "publish/publisher.h"

namespace bole {

/// Tree lists as lines of JSON, each written at once; no statuses: a line is a list. One that was
/// only taken in part, as by a full disk, is left behind; the next begins on a new line.
class JsonlPublisher : public Publisher {
 public:
  /// `target`: a path, whose file is made anew, or "-" for standard output. Throws ConfigError when
  /// it cannot be written.
  explicit JsonlPublisher(const std::filesystem::path& target);

  std::string name() const override { return "jsonl"; }
  bool carries(MessageKind kind) const override { return kind == MessageKind::trees; }
  void publish(MessageKind kind, std::span<const std::byte> bytes,
               const std::string& file) override;
  void interrupt() noexcept override { interrupted_.raise(); }

 private:
  void write_all(std::string_view text);

  UniqueFd fd_;
  Wakeup interrupted_;
  std::string line_;
  bool torn_ = false;  // only the beginning of the last line was taken
};

}  // namespace bole
