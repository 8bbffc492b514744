#include "detect/network.h"

#include <algorithm>
#include <cmath>

#include "detect/dense_layer.h"

namespace bole {
namespace {

#include "detect/weights.inc"

static_assert(weights::kInputs == TrunkFeatures::kCount, "train the network anew");

// The second layer's weights with columns of zeros, for whole vectors.
constexpr int kWidth = 8;
static_assert(weights::kOutputs <= kWidth);
constexpr auto kSecond = [] {
  std::array<std::array<float, kWidth>, weights::kHidden> padded{};
  for (int j = 0; j < weights::kHidden; ++j)
    for (int k = 0; k < weights::kOutputs; ++k) padded[j][k] = weights::kSecond[j][k];
  return padded;
}();

}  // namespace

Judgement judge(const TrunkFeatures::Values& features) {
  // What was never seen in training is taken for the most extreme that was.
  std::array<float, weights::kInputs> inputs;
  standardise(features.data(), weights::kInputs, weights::kMean, weights::kScale, weights::kLimit,
              inputs.data());
  std::array<float, weights::kHidden> hidden = weights::kHiddenBias;
  static_assert(weights::kHidden % 48 == 0);
  add_dense(inputs.data(), weights::kInputs, &weights::kFirst[0][0], weights::kHidden,
            hidden.data());
  for (float& value : hidden) value = std::max(value, 0.05F * value);
  std::array<float, kWidth> out{};
  std::copy(weights::kOutputBias.begin(), weights::kOutputBias.end(), out.begin());
  add_dense(hidden.data(), weights::kHidden, kSecond[0].data(), kWidth, out.data());
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
