#pragma once

#include <cmath>
#include <numbers>

namespace bole {

inline constexpr double kPi = std::numbers::pi;

constexpr double radians(double degrees) { return degrees * (kPi / 180.0); }
constexpr double degrees(double radians) { return radians * (180.0 / kPi); }

/// The angle equal to `angle` modulo a full turn, in [-pi, pi).
inline double wrap_angle(double angle) {
  return angle - 2 * kPi * std::floor((angle + kPi) / (2 * kPi));
}

}  // namespace bole
