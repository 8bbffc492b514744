#pragma once

#include <cstdint>

namespace bole {

/// A driver's 32-bit frame count as one that does not wrap round.
class SequenceCount {
 public:
  std::int64_t extend(std::uint32_t sequence);

 private:
  bool any_ = false;
  std::uint32_t last_ = 0;
  std::int64_t extended_ = 0;
};

}  // namespace bole
