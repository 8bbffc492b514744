#include "publish/stream_figures.h"

#include <array>
#include <cstdio>

#include <nlohmann/json.hpp>

namespace bole {
namespace {

double ms(std::int64_t ns) { return static_cast<double>(ns) / 1e6; }

// Of numbers from the bus, where anybody may have put them: wraps round in place of overflowing.
std::int64_t difference(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}

}  // namespace

void StreamFigures::add(const tree_list_t& list, std::int64_t arrival_mono_ns) {
  if (lists_ == 0) first_arrival_ns_ = arrival_mono_ns;
  if (last_seq_ >= 0 && list.seq > last_seq_) {
    lost_ = difference(lost_, last_seq_ + 1 - list.seq);
  }
  if (list.seq <= last_seq_) ++restarts_;
  last_seq_ = list.seq;
  last_arrival_ns_ = arrival_mono_ns;
  latency_.add(difference(list.publish_mono_ns, list.capture_mono_ns));
  delivery_.add(difference(arrival_mono_ns, list.publish_mono_ns));
  ++lists_;
}

double StreamFigures::rate() const {
  const double seconds = static_cast<double>(last_arrival_ns_ - first_arrival_ns_) / 1e9;
  return lists_ > 1 && seconds > 0 ? static_cast<double>(lists_ - 1) / seconds : 0;
}

std::string StreamFigures::text() const {
  std::array<char, 256> line;
  std::snprintf(line.data(), line.size(),
                "%lld lists, %.1f/s, %lld lost, %lld restarts, %lld foreign; capture to publish "
                "p50 %.2f p99 %.2f max %.2f ms; publish to here p50 %.2f p99 %.2f ms",
                static_cast<long long>(lists_), rate(), static_cast<long long>(lost_),
                static_cast<long long>(restarts_), static_cast<long long>(foreign_),
                ms(latency_.quantile(0.5)), ms(latency_.quantile(0.99)), ms(latency_.max()),
                ms(delivery_.quantile(0.5)), ms(delivery_.quantile(0.99)));
  return line.data();
}

std::string StreamFigures::json(const std::string& stream) const {
  return nlohmann::ordered_json{{"stream", stream},
                                {"summary",
                                 {{"lists", lists_},
                                  {"rate", rate()},
                                  {"lost", lost_},
                                  {"restarts", restarts_},
                                  {"foreign", foreign_},
                                  {"latency_p50_ms", ms(latency_.quantile(0.5))},
                                  {"latency_p99_ms", ms(latency_.quantile(0.99))},
                                  {"latency_max_ms", ms(latency_.max())},
                                  {"delivery_p50_ms", ms(delivery_.quantile(0.5))},
                                  {"delivery_p99_ms", ms(delivery_.quantile(0.99))}}}}
      .dump();
}

}  // namespace bole
