#pragma once

#include <cmath>
#include <cstdint>

namespace bole::simulate {

/// Scrambles 32 bits: every bit of the result depends on every bit of `x`.
constexpr std::uint32_t scramble(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  x ^= x >> 16;
  return x;
}

constexpr std::uint32_t hash(std::uint32_t a, std::uint32_t b, std::uint32_t seed) {
  return scramble(seed + a * 0x9e3779b1U + b * 0x85ebca77U);
}

/// [0, 1), from the upper 24 bits.
constexpr float unit(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24F; }

/// A stream of numbers that follows from its key alone: the standard library's distributions give
/// other numbers on other machines.
class Random {
 public:
  explicit constexpr Random(std::uint64_t key, std::uint32_t stream = 0)
      : key_(scramble(static_cast<std::uint32_t>(key)) ^
             scramble(static_cast<std::uint32_t>(key >> 32) + 0x68bc21ebU) ^
             scramble(stream + 0x02e5be93U)) {}

  constexpr std::uint32_t bits() { return hash(++count_, 0, key_); }
  constexpr float uniform(float low, float high) { return low + (high - low) * unit(bits()); }
  constexpr bool chance(float probability) { return unit(bits()) < probability; }
  /// Zero mean, unit variance, within 6: the sum of twelve uniform numbers.
  constexpr float normal() {
    float sum = -6;
    for (int i = 0; i < 12; ++i) sum += unit(bits());
    return sum;
  }

 private:
  std::uint32_t key_;
  std::uint32_t count_ = 0;
};

inline int floor_to_int(float x) {
  const int i = static_cast<int>(x);
  return i - (static_cast<float>(i) > x ? 1 : 0);
}

inline float fade(float t) { return t * t * (3 - 2 * t); }
inline float mix(float a, float b, float t) { return a + (b - a) * t; }

/// 0 below `low`, 1 above `high`, smooth between.
inline float smooth_step(float low, float high, float x) {
  const float t = (x - low) / (high - low);
  return t <= 0 ? 0 : t >= 1 ? 1 : fade(t);
}

/// Smooth value noise in [-1, 1] with one knot a unit.
inline float noise(float x, std::uint32_t seed) {
  const int i = floor_to_int(x);
  const float a = unit(hash(i, 0, seed)), b = unit(hash(i + 1, 0, seed));
  return 2 * mix(a, b, fade(x - static_cast<float>(i))) - 1;
}

inline float noise(float x, float y, std::uint32_t seed) {
  const int i = floor_to_int(x), j = floor_to_int(y);
  const float u = fade(x - static_cast<float>(i)), v = fade(y - static_cast<float>(j));
  const float low = mix(unit(hash(i, j, seed)), unit(hash(i + 1, j, seed)), u);
  const float high = mix(unit(hash(i, j + 1, seed)), unit(hash(i + 1, j + 1, seed)), u);
  return 2 * mix(low, high, v) - 1;
}

inline float noise(float x, float y, float z, std::uint32_t seed) {
  const int k = floor_to_int(z);
  const auto layer = [&](int at) {
    return noise(x, y, seed ^ (static_cast<std::uint32_t>(at) * 0xc2b2ae3dU));
  };
  return mix(layer(k), layer(k + 1), fade(z - static_cast<float>(k)));
}

/// How much of a wave of `frequency` (knots a metre) is left when a pixel spans `footprint` metres.
inline float resolved(float frequency, float footprint) {
  return 1 - smooth_step(0.3F, 1.0F, frequency * footprint);
}

/// Octaves of noise about 0, each twice as fine and `gain` times as strong as the one before, with
/// the variance of a single one (a standard deviation of about 0.35); those finer than the pixel's
/// footprint are left out, so that nothing flickers.
inline float fractal(float x, float y, float frequency, int octaves, float gain, float footprint,
                     std::uint32_t seed) {
  float sum = 0, strength = 1, power = 0;
  for (int octave = 0; octave < octaves; ++octave) {
    const float left = resolved(frequency, footprint);
    if (left > 0) sum += strength * left * noise(x * frequency, y * frequency, seed + octave);
    power += strength * strength;
    frequency *= 2.03F;
    strength *= gain;
  }
  return sum / std::sqrt(power);
}

}  // namespace bole::simulate
