#include "capture/sequence_count.h"

namespace bole {

std::int64_t SequenceCount::extend(std::uint32_t sequence) {
  constexpr std::uint32_t kHalf = 1U << 31;
  const std::uint32_t step = sequence - last_;
  if (!any_) {
    extended_ = sequence;
  } else {
    extended_ += step < kHalf ? step : 1;  // a count that begins anew goes on as if it had not
  }
  any_ = true;
  last_ = sequence;
  return extended_;
}

}  // namespace bole
