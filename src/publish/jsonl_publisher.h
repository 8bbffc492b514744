#pragma once

#include <filesystem>
#include <string_view>

#include "base/files.h"
#include "base/wakeup.h"
#include "publish/publisher.h"

namespace bole {

/// Tree lists as lines of JSON, each written at once; no statuses: a line is a list. One that was
/// only taken in part, as by a full disk, is left behind; the next begins on a new line. Standard
/// output whose reader has gone is a BusGone; a named pipe may find another.
class JsonlPublisher : public Publisher {
 public:
  /// What becomes of the lists that the file holds already.
  enum class Earlier { kept, erased };

  /// `target`: a path, or "-" for standard output. Every line goes to the end of the file, also
  /// after somebody else has cut it, as logrotate's copytruncate does. Throws ConfigError when it
  /// cannot be written, which names `origin` as the configuration's file.
  explicit JsonlPublisher(const std::filesystem::path& target, Earlier earlier = Earlier::kept,
                          const std::string& origin = "");

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
  const bool to_stdout_;
  bool torn_;  // the file ends within a line
};

}  // namespace bole
