#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <vector>

namespace bole {

/// Where the time of frames goes, in the trace-event format of Chrome (chrome://tracing, Perfetto).
/// Spans are kept in memory reserved at the start and written when it is destroyed; when the memory
/// is full, later ones are left out. Any thread may record.
class Trace {
 public:
  /// A row of the picture.
  enum class Lane : std::uint8_t { capture, processing, bus };

  /// Throws ConfigError when `file` cannot be written.
  explicit Trace(std::filesystem::path file);
  ~Trace();
  Trace(const Trace&) = delete;
  Trace& operator=(const Trace&) = delete;

  /// Something that frame `seq` went through, on CLOCK_MONOTONIC. `what` must live as long as this.
  void record(const char* what, Lane lane, std::int64_t seq, std::int64_t start_ns,
              std::int64_t end_ns);

 private:
  struct Span {
    const char* what;
    std::int64_t seq, start_ns, end_ns;
    Lane lane;
  };

  std::filesystem::path file_;
  std::mutex mutex_;
  std::vector<Span> spans_;
};

}  // namespace bole
