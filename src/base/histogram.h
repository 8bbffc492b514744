#pragma once

#include <array>
#include <cstdint>

namespace bole {

/// Counts durations in bins whose width is at most 1/32 of the duration, from 1 ns to days, in a
/// fixed 15 kB: quantiles over any number of values without keeping them.
class DurationHistogram {
 public:
  /// Negative durations count as 0.
  void add(std::int64_t ns);

  std::int64_t count() const { return count_; }
  std::int64_t max() const { return max_; }
  /// The duration, ns, below which the share `q` (0 to 1) of the values lies, at most 1/32 too
  /// large; 0 without values.
  std::int64_t quantile(double q) const;

 private:
  static constexpr int kBinsAnOctave = 32;
  static constexpr int kOctaves = 59;

  std::array<std::int64_t, static_cast<std::size_t>(kBinsAnOctave) * kOctaves> bins_{};
  std::int64_t count_ = 0;
  std::int64_t max_ = 0;
};

}  // namespace bole
