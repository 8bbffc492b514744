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
alignas(64) constexpr auto kFirst = [] {
  std::array<std::int16_t, std::size_t{2} * kPairs * weights::kHidden> units{};
  for (int j = 0; j < weights::kHidden; ++j) {
    float all = 0;
    for (int i = 0; i < weights::kInputs; ++i) {
      const float weight = weights::kFirst[i][j], size = weight < 0 ? -weight : weight;
      all += size;
      if (size > kMostWeight || all > kMostWeightsOfUnit) throw "too large for whole numbers";
      units[(i / 2 * weights::kHidden + j) * 2 + i % 2] =
          static_cast<std::int16_t>(weight * kWeightUnits + (weight < 0 ? -0.5F : 0.5F));
    }
  }
  return units;
}();

// The second layer's weights with columns of zeros, for whole vectors.
static_assert(weights::kOutputs <= kOutputLanes);
alignas(64) constexpr auto kSecond = [] {
  std::array<std::array<float, kOutputLanes>, weights::kHidden> padded{};
  for (int j = 0; j < weights::kHidden; ++j)
    for (int k = 0; k < weights::kOutputs; ++k) padded[j][k] = weights::kSecond[j][k];
  return padded;
}();

}  // namespace

Judgement judge(const TrunkFeatures::Values& features) {
  // What was never seen in training is taken for the most extreme that was.
  std::array<std::int16_t, std::size_t{2} * kPairs> inputs;
  inputs.back() = 0;
  standardise(features.data(), weights::kInputs, weights::kMean, weights::kScale, weights::kLimit,
              inputs.data());
  std::array<float, weights::kHidden> hidden;
  static_assert(weights::kHidden % 48 == 0);
  hidden_layer(inputs.data(), kPairs, kFirst.data(), weights::kHiddenBias.data(), weights::kHidden,
               hidden.data());
  std::array<float, kOutputLanes> out{};
  std::copy(weights::kOutputBias.begin(), weights::kOutputBias.end(), out.begin());
  output_layer(hidden.data(), weights::kHidden, kSecond[0].data(), out.data());
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
