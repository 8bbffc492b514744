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

// From the first hidden layer on.
Judgement judge_units(const float* first) {
  std::array<float, weights::kSecond> second = weights::kSecondBias;
  add_products(first, weights::kFirst, weights::kToSecond[0], weights::kSecond, second.data());
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

}  // namespace

void judge(std::span<const TrunkFeatures::Values> features, std::span<Judgement> judgements) {
  std::array<std::array<std::int16_t, std::size_t{2} * kPairs>, kLooksAtOnce> inputs;
  std::array<std::array<float, weights::kFirst>, kLooksAtOnce> first;
  static_assert(weights::kFirst % 48 == 0);
  for (std::size_t done = 0; done < features.size();) {
    const std::size_t count = std::min<std::size_t>(kLooksAtOnce, features.size() - done);
    for (std::size_t i = 0; i < count; ++i) {
      // What was never seen in training is taken for the most extreme that was.
      inputs[i].back() = 0;
      standardise(features[done + i].data(), weights::kInputs, weights::kMean, weights::kScale,
                  weights::kLimit, inputs[i].data());
    }
    hidden_layer(inputs[0].data(), static_cast<int>(count), kPairs, kToFirst.data(),
                 weights::kFirstBias.data(), weights::kFirst, first[0].data());
    for (std::size_t i = 0; i < count; ++i) judgements[done + i] = judge_units(first[i].data());
    done += count;
  }
}

Judgement judge(const TrunkFeatures::Values& features) {
  Judgement judgement;
  judge(std::span(&features, 1), std::span(&judgement, 1));
  return judgement;
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
