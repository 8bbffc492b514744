#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "detect/network/dense_layer.h"
#include "detect/network/network.h"

namespace bole {

/// What the networks make of their weights while they are compiled, and how they end.

/// A wide layer's weights in whole units, two inputs side by side.
template <std::size_t kInputs, std::size_t kUnits>
constexpr auto whole_units(const float (&weights)[kInputs][kUnits]) {
  std::array<std::int16_t, (kInputs + 1) / 2 * 2 * kUnits> units{};
  for (std::size_t j = 0; j < kUnits; ++j) {
    float all = 0;
    for (std::size_t i = 0; i < kInputs; ++i) {
      const float weight = weights[i][j], size = weight < 0 ? -weight : weight;
      all += size;
      if (size > kMostWeight || all > kMostWeightsOfUnit) throw "too large for whole numbers";
      units[(i / 2 * kUnits + j) * 2 + i % 2] =
          static_cast<std::int16_t>(weight * kWeightUnits + (weight < 0 ? -0.5F : 0.5F));
    }
  }
  return units;
}

/// A last layer's weights with columns of zeros, for whole vectors.
inline constexpr int kOutputWidth = 8;
template <std::size_t kUnits, std::size_t kOutputs>
constexpr auto padded(const float (&weights)[kUnits][kOutputs]) {
  static_assert(kOutputs <= kOutputWidth);
  std::array<std::array<float, kOutputWidth>, kUnits> wide{};
  for (std::size_t j = 0; j < kUnits; ++j)
    for (std::size_t k = 0; k < kOutputs; ++k) wide[j][k] = weights[j][k];
  return wide;
}

template <std::size_t kUnits>
Judgement judgement_of(const std::array<float, kUnits>& last,
                       const std::array<std::array<float, kOutputWidth>, kUnits>& to_output,
                       std::span<const float> bias) {
  std::array<float, kOutputWidth> out{};
  std::copy(bias.begin(), bias.end(), out.begin());
  add_products(last.data(), kUnits, to_output[0].data(), kOutputWidth, out.data());
  return {.logit = out[0],
          .centre_shift = out[1],
          .log_width = out[2],
          .foot_shift = out[3],
          .log_sigma = {out[4], out[5], out[6]}};
}

/// The same of a network whose first layer's units are known.
template <std::size_t kFirst, std::size_t kSecond>
Judgement judgement_of(const std::array<float, kFirst>& first,
                       const float (&to_second)[kFirst][kSecond],
                       const std::array<float, kSecond>& second_bias,
                       const std::array<std::array<float, kOutputWidth>, kSecond>& to_output,
                       std::span<const float> bias) {
  std::array<float, kSecond> second = second_bias;
  add_products(first.data(), kFirst, to_second[0], kSecond, second.data());
  for (float& value : second) value = std::max(value, value * kLeak);
  return judgement_of(second, to_output, bias);
}

}  // namespace bole
