#include "detect/network/last_look.h"

#include <array>
#include <cstddef>
#include <cstdint>

#include "detect/network/network_weights.h"

namespace bole {
namespace {

#include "detect/network/last_look_weights.inc"

namespace w = last_look_weights;

constexpr int kFeatures = TrunkFeatures::kCount;
constexpr int kPairs = (w::kInputs + 1) / 2;
static_assert(w::kInputs == kFeatures + FootPatch::kCount && w::kLimit <= kMostInput,
              "train the networks anew");

alignas(64) constexpr auto kToFirst = whole_units(w::kToFirst);
alignas(64) constexpr auto kToOutput = padded(w::kToOutput);

}  // namespace

Judgement locate(const TrunkFeatures::Values& features, const FootPatch::Values& foot) {
  alignas(64) std::array<std::int16_t, std::size_t{2} * kPairs> inputs;
  inputs.back() = 0;
  standardise(features.data(), kFeatures, w::kMean, w::kScale, w::kLimit, inputs.data());
  standardise(foot.data(), FootPatch::kCount, w::kMean + kFeatures, w::kScale + kFeatures,
              w::kLimit, inputs.data() + kFeatures);
  std::array<float, w::kFirst> first;
  hidden_layer(inputs.data(), 1, kPairs, kToFirst.data(), w::kFirstBias.data(), w::kFirst,
               first.data());
  return judgement_of(first, w::kToSecond, w::kSecondBias, kToOutput, w::kOutputBias);
}

}  // namespace bole
