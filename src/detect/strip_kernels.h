#pragma once

#include <array>
#include <cstdint>

namespace bole {

/// The sum of `count` pixels.
int sum_pixels(const std::uint8_t* pixels, int count);

/// Three strips of a row of pixels, from left to right: columns [first, last) each.
struct RowStrips {
  static constexpr int kCount = 3;
  static constexpr int kUnderread = 63;  ///< pixels that may be read before the first strip
  std::array<int, kCount> first{}, last{};
};

/// The sum of each strip's pixels; all three together are below 2^21 each.
std::array<int, RowStrips::kCount> sum_strips(const std::uint8_t* row, const RowStrips& strips);
std::array<int, RowStrips::kCount> sum_strips_plain(const std::uint8_t* row,
                                                    const RowStrips& strips);

}  // namespace bole
