#include "base/histogram.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace bole {
namespace {

// Below 64 each value has a bin of its own; above, an octave has 32.
std::size_t bin_of(std::int64_t value) {
  const auto v = static_cast<std::uint64_t>(value);
  if (v < 64) return static_cast<std::size_t>(v);
  const auto shift = static_cast<std::size_t>(std::bit_width(v)) - 6;
  return shift * 32 + static_cast<std::size_t>(v >> shift);
}

std::int64_t largest_in(std::size_t bin) {
  if (bin < 64) return static_cast<std::int64_t>(bin);
  const std::size_t shift = bin / 32 - 1;
  return static_cast<std::int64_t>(((bin % 32 + 33) << shift) - 1);
}

}  // namespace

void DurationHistogram::add(std::int64_t ns) {
  ns = std::max<std::int64_t>(ns, 0);
  ++bins_[std::min(bin_of(ns), bins_.size() - 1)];
  ++count_;
  max_ = std::max(max_, ns);
}

std::int64_t DurationHistogram::quantile(double q) const {
  const auto rank = static_cast<std::int64_t>(std::ceil(q * static_cast<double>(count_)));
  std::int64_t below = 0;
  for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
    below += bins_[bin];
    if (below > 0 && below >= rank) return std::min(largest_in(bin), max_);
  }
  return 0;
}

}  // namespace bole
