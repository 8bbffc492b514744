#include "detect/network/network.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "detect/network/dense_layer.h"
#include "detect/network/network_weights.h"

namespace bole {
namespace {

#include "detect/network/glance_weights.inc"
#include "detect/network/look_weights.inc"

using F = TrunkFeatures;

// What a glance leaves out lies between the grid and the numbers, and at the end.
constexpr int kGlanced = F::kNumbers + F::kRowContrasts;

static_assert(look_weights::kInputs == F::kCount, "train the networks anew");
static_assert(glance_weights::kInputs == F::kGrid + kGlanced, "train the networks anew");
static_assert(look_weights::kLimit <= kMostInput && glance_weights::kLimit <= kMostInput);

alignas(64) constexpr auto kToFirst = whole_units(look_weights::kToFirst);
alignas(64) constexpr auto kGlanceToFirst = whole_units(glance_weights::kToFirst);

alignas(64) constexpr auto kToOutput = padded(look_weights::kToOutput);
alignas(64) constexpr auto kGlanceToOutput = padded(glance_weights::kToOutput);

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
    standardise(values, look_weights::kInputs, look_weights::kMean, look_weights::kScale,
                look_weights::kLimit, inputs);
  };
  judge_all<look_weights::kInputs>(
      features, judgements, kToFirst.data(), look_weights::kFirstBias, standardise_look,
      [](const std::array<float, look_weights::kFirst>& first) {
        return judgement_of(first, look_weights::kToSecond, look_weights::kSecondBias, kToOutput,
                            look_weights::kOutputBias);
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
