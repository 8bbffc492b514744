#pragma once

#include <cstdint>
#include <string>

#include "base/histogram.h"
#include "bole/tree_list_t.hpp"

namespace bole {

/// What a receiver can tell about a stream of lists from the lists alone.
class StreamFigures {
 public:
  /// `arrival_mono_ns`: CLOCK_MONOTONIC of the receiver.
  void add(const tree_list_t& list, std::int64_t arrival_mono_ns);
  /// A payload on our channel that was not one of ours.
  void add_foreign() { ++foreign_; }

  std::int64_t lists() const { return lists_; }
  /// Gaps in `seq`: lists that were published and did not arrive.
  std::int64_t lost() const { return lost_; }

  /// "120 lists, 10.0/s, 0 lost, ..." for people.
  std::string text() const;
  /// The same as one line of JSON, {"stream": ..., "summary": {...}}.
  std::string json(const std::string& stream) const;

 private:
  double rate() const;

  std::int64_t lists_ = 0;
  std::int64_t lost_ = 0;
  std::int64_t restarts_ = 0;
  std::int64_t foreign_ = 0;
  std::int64_t last_seq_ = -1;
  std::int64_t first_arrival_ns_ = 0;
  std::int64_t last_arrival_ns_ = 0;
  DurationHistogram latency_;   // capture to publish, as the message says
  DurationHistogram delivery_;  // publish to arrival; only meaningful on the camera's computer
};

}  // namespace bole
