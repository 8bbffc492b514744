#include "detect/network.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "detect/dense_layer.h"

namespace bole {
namespace {

#include "detect/weights.inc"

static_assert(weights::kInputs == TrunkFeatures::kCount, "train the network anew");

static_assert(weights::kLimit <= kMostInput);

// The first layer's weights in whole units, two inputs side by side.
constexpr int kPairs = (weights::kInputs + 1) / 2;
alignas(64) constexpr auto kToFirst = [] {
  std::array<std::int16_t, std::size_t{2} * kPairs * weights::kFirst> units{};
  for (int j = 0; j < weights::kFirst; ++j) {
    float all = 0;
    for (int i = 0; i < weights::kInputs; ++i) {
      const float weight = weights::kToFirst[i][j], size = weight < 0 ? -weight : weight;
      all += size;
      if (size > kMostWeight || all > kMostWeightsOfUnit) throw "too large for whole numbers";
      units[(i / 2 * weights::kFirst + j) * 2 + i % 2] =
          static_cast<std::int16_t>(weight * kWeightUnits + (weight < 0 ? -0.5F : 0.5F));
    }
  }
  return units;
}();

// The last layer's weights with columns of zeros, for whole vectors.
constexpr int kWidth = 8;
static_assert(weights::kOutputs <= kWidth);
alignas(64) constexpr auto kToOutput = [] {
  std::array<std::array<float, kWidth>, weights::kSecond> padded{};
  for (int j = 0; j < weights::kSecond; ++j)
    for (int k = 0; k < weights::kOutputs; ++k) padded[j][k] = weights::kToOutput[j][k];
  return padded;
}();

}  // namespace

Judgement judge(const TrunkFeatures::Values& features) {
  // What was never seen in training is taken for the most extreme that was.
  std::array<std::int16_t, std::size_t{2} * kPairs> inputs;
  inputs.back() = 0;
  standardise(features.data(), weights::kInputs, weights::kMean, weights::kScale, weights::kLimit,
              inputs.data());
  std::array<float, weights::kFirst> first;
  static_assert(weights::kFirst % 48 == 0);
  hidden_layer(inputs.data(), kPairs, kToFirst.data(), weights::kFirstBias.data(), weights::kFirst,
               first.data());
  std::array<float, weights::kSecond> second = weights::kSecondBias;
  add_products(first.data(), weights::kFirst, weights::kToSecond[0], weights::kSecond,
               second.data());
  for (float& value : second) value = std::max(value, value * kLeak);
  std::array<float, kWidth> out{};
  std::copy(weights::kOutputBias.begin(), weights::kOutputBias.end(), out.begin());
  add_products(second.data(), weights::kSecond, kToOutput[0].data(), kWidth, out.data());
  return {.logit = out[0],
          .centre_shift = out[1],
          .log_width = out[2],
          .foot_shift = out[3],
          .log_sigma = {out[4], out[5], out[6]}};
}

TrunkShape corrected(const TrunkShape& shape, const Judgement& judgement, double focal) {
  TrunkShape better = shape;
  const float down = std::clamp(judgement.foot_shift, -8.0F, 8.0F) * foot_unit(shape, focal);
  const float middle = shape.centre() +
                       std::clamp(judgement.centre_shift, -0.5F, 0.5F) * shape.width() +
                       shape.slope() * down;
  const float half = 0.5F * shape.width() * std::exp(std::clamp(judgement.log_width, -0.6F, 0.6F));
  better.foot = shape.foot + down;
  better.left = middle - half;
  better.right = middle + half;
  return better;
}

}  // namespace bole
