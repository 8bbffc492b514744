#pragma once

namespace bole {

/// Added before a truncation, it makes that round down; with another half, to the nearest whole
/// number. For columns, rows and units, which stay far from it on either side; the vector kernels
/// and their plain loops round alike so.
inline constexpr float kFar = 16384;

/// value * factor / 2^15, to the nearest: what Highway calls MulFixedPoint15.
constexpr int times_fixed_point15(int value, int factor) {
  return (value * factor + (1 << 14)) >> 15;
}

}  // namespace bole
