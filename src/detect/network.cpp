#include "detect/network.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "detect/dense_layer.h"

namespace bole {
namespace {

#include "detect/glance_weights.inc"
#include "detect/weights.inc"

using F = TrunkFeatures;

// What a glance leaves out lies between the grid and the numbers, and at the end.
constexpr int kGlanced = F::kNumbers + F::kRowContrasts;

static_assert(weights::kInputs == F::kCount, "train the networks anew");
static_assert(glance_weights::kInputs == F::kGrid + kGlanced, "train the networks anew");
static_assert(weights::kLimit <= kMostInput && glance_weights::kLimit <= kMostInput);

// A first layer's weights in whole units, two inputs side by side.
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
alignas(64) constexpr auto kToFirst = whole_units(weights::kToFirst);
alignas(64) constexpr auto kGlanceToFirst = whole_units(glance_weights::kToFirst);

// A last layer's weights with columns of zeros, for whole vectors.
constexpr int kWidth = 8;
template <std::size_t kUnits, std::size_t kOutputs>
constexpr auto padded(const float (&weights)[kUnits][kOutputs]) {
  static_assert(kOutputs <= kWidth);
  std::array<std::array<float, kWidth>, kUnits> wide{};
  for (std::size_t j = 0; j < kUnits; ++j)
    for (std::size_t k = 0; k < kOutputs; ++k) wide[j][k] = weights[j][k];
  return wide;
}
alignas(64) constexpr auto kToOutput = padded(weights::kToOutput);
alignas(64) constexpr auto kGlanceToOutput = padded(glance_weights::kToOutput);

template <std::size_t kUnits>
Judgement judgement_of(const std::array<float, kUnits>& last,
                       const std::array<std::array<float, kWidth>, kUnits>& to_output,
                       std::span<const float> bias) {
  std::array<float, kWidth> out{};
  std::copy(bias.begin(), bias.end(), out.begin());
  add_products(last.data(), kUnits, to_output[0].data(), kWidth, out.data());
  return {.logit = out[0],
          .centre_shift = out[1],
          .log_width = out[2],
          .foot_shift = out[3],
          .log_sigma = {out[4], out[5], out[6]}};
}

// Of some looks at a time, the units of a first layer; `standardise_look(values, inputs)` makes its
// inputs and `judge_look(units)` a judgement of them.
template <int kInputs, std::size_t kUnits, class StandardiseLook, class JudgeLook>
void judge_all(std::span<const F::Values> features, std::span<Judgement> judgements,
               const std::int16_t* to_first, const std::array<float, kUnits>& bias,
               const StandardiseLook& standardise_look, const JudgeLook& judge_look) {
  constexpr int kPairs = (kInputs + 1) / 2;
  static_assert(kUnits % 48 == 0);
  std::array<std::array<std::int16_t, std::size_t{2} * kPairs>, kLooksAtOnce> inputs;
  std::array<std::array<float, kUnits>, kLooksAtOnce> first;
  for (std::size_t done = 0; done < features.size();) {
    const std::size_t count = std::min<std::size_t>(kLooksAtOnce, features.size() - done);
    for (std::size_t i = 0; i < count; ++i) {
      inputs[i].back() = 0;
      standardise_look(features[done + i].data(), inputs[i].data());
    }
    hidden_layer(inputs[0].data(), static_cast<int>(count), kPairs, to_first, bias.data(), kUnits,
                 first[0].data());
    for (std::size_t i = 0; i < count; ++i) judgements[done + i] = judge_look(first[i]);
    done += count;
  }
}

}  // namespace

// What was never seen in training is taken for the most extreme that was.
void judge(std::span<const F::Values> features, std::span<Judgement> judgements) {
  const auto standardise_look = [](const float* values, std::int16_t* inputs) {
    standardise(values, weights::kInputs, weights::kMean, weights::kScale, weights::kLimit, inputs);
  };
  judge_all<weights::kInputs>(features, judgements, kToFirst.data(), weights::kFirstBias,
                              standardise_look,
                              [](const std::array<float, weights::kFirst>& first) {
                                std::array<float, weights::kSecond> second = weights::kSecondBias;
                                add_products(first.data(), weights::kFirst, weights::kToSecond[0],
                                             weights::kSecond, second.data());
                                for (float& value : second) value = std::max(value, value * kLeak);
                                return judgement_of(second, kToOutput, weights::kOutputBias);
                              });
}

void judge_at_a_glance(std::span<const F::Values> features, std::span<Judgement> judgements) {
  const auto standardise_look = [](const float* values, std::int16_t* inputs) {
    using namespace glance_weights;
    standardise(values, F::kGrid, kMean, kScale, kLimit, inputs);
    standardise(values + F::kGrid + F::kFoot, kGlanced, kMean + F::kGrid, kScale + F::kGrid, kLimit,
                inputs + F::kGrid);
  };
  judge_all<glance_weights::kInputs>(
      features, judgements, kGlanceToFirst.data(), glance_weights::kFirstBias, standardise_look,
      [](const std::array<float, glance_weights::kFirst>& first) {
        return judgement_of(first, kGlanceToOutput, glance_weights::kOutputBias);
      });
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
