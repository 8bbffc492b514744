#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace bole {

/// Why a frame of the camera never became a Frame that was processed.
enum class DropCause : std::uint8_t {
  superseded,  ///< a newer one was there already
  missing,     ///< a gap in the sensor's count: lost before us
  damaged,     ///< the driver marked it as faulty
  too_short,   ///< fewer bytes than the format needs
  unreadable,  ///< a replayed file that cannot be read, decoded or does not fit the calibration
};
inline constexpr std::array<std::string_view, 5> kDropCauseNames = {
    "superseded", "missing", "damaged", "too_short", "unreadable"};

/// Frames lost, by cause.
class DropCounts {
 public:
  std::int64_t& operator[](DropCause cause) { return counts_.at(static_cast<std::size_t>(cause)); }
  std::int64_t operator[](DropCause cause) const {
    return counts_.at(static_cast<std::size_t>(cause));
  }
  DropCounts& operator+=(const DropCounts& other) {
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_.at(i) += other.counts_.at(i);
    return *this;
  }
  std::int64_t total() const {
    std::int64_t sum = 0;
    for (const std::int64_t count : counts_) sum += count;
    return sum;
  }
  /// In the order of kDropCauseNames.
  const std::array<std::int64_t, kDropCauseNames.size()>& by_cause() const { return counts_; }

 private:
  std::array<std::int64_t, kDropCauseNames.size()> counts_{};
};

}  // namespace bole
