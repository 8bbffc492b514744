#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/histogram.h"
#include "bole/status_t.hpp"
#include "capture/supervisor.h"

namespace bole {

/// Why a frame that the camera delivered gave no list, beside capture's own DropCauses.
struct ProcessingDrops {
  std::int64_t overwritten = 0;  ///< a newer one came before processing was free
  std::int64_t unusable = 0;     ///< damaged, cut short, of another size
};

/// Everything that a status and the closing summary tell, collected from the pipeline's threads.
class Telemetry {
 public:
  Telemetry(std::string version, std::string camera);

  void capture_event(const CameraEvent& event);
  void capture_counts(const CaptureCounts& counts);
  /// A frame was overwritten before processing took it.
  void overwritten();
  /// A frame that capture could not use (it counts them itself). Each reason is logged once.
  void bad_frame(const std::string& reason);
  /// A frame that processing could not use. Each reason is logged once, then counted.
  void unusable(std::string_view file, const std::string& reason);
  /// A list was encoded; `latency_ns` from capture to publish.
  void processed(std::int64_t latency_ns, std::int64_t trees_rejected);
  /// Why the camera cannot see well; empty when it can.
  void vision(std::string_view reason);

  /// The status now, without the clocks and the buses. Rates are over the time since the last call,
  /// or the one before where that was less than half a second ago. What frames show (degraded,
  /// latencies) is told while the camera streams, and of frames since it does.
  status_t status(std::int64_t now_ns, bool stopping);

  struct Summary {
    std::int64_t frames = 0;
    std::int64_t lists = 0;
    std::vector<counter_t> drops;
    std::int64_t latency_p50_ns = 0, latency_p99_ns = 0, latency_max_ns = 0;
  };
  Summary summary() const;

 private:
  static constexpr std::size_t kRecent = 512;

  std::vector<counter_t> drops() const;
  std::vector<counter_t> camera_events() const;
  void note(const std::string& trouble);
  void forget_frames();
  void tell_frames(status_t& status) const;
  void take_rates(std::int64_t now_ns);

  mutable std::mutex mutex_;
  const std::string version_;
  const std::string camera_;
  CameraEvent event_{CameraState::starting, "", false};
  std::string source_;
  CaptureCounts capture_;
  ProcessingDrops dropped_;
  std::int64_t trees_rejected_ = 0;
  std::int64_t lists_ = 0;
  std::string degraded_reason_;
  std::string last_error_;
  std::set<std::string> told_;
  DurationHistogram latency_;
  std::array<std::int64_t, kRecent> recent_{};  // latencies, a ring
  std::size_t recent_count_ = 0;                // of them since the camera streams

  std::int64_t start_ns_ = 0;
  std::int64_t rates_taken_ns_ = 0;
  std::int64_t rated_frames_ = 0, rated_lists_ = 0;
  float frame_rate_ = 0, list_rate_ = 0;
};

}  // namespace bole
