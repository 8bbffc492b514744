#include "detect/network.h"

#include <algorithm>
#include <cmath>

#include "detect/dense_layer.h"

namespace bole {
namespace {

#include "detect/weights.inc"

static_assert(weights::kInputs == TrunkFeatures::kCount, "train the network anew");

}  // namespace

Judgement judge(const TrunkFeatures::Values& features) {
  std::array<float, weights::kHidden> hidden = weights::kHiddenBias;
  // What was never seen in training is taken for the most extreme that was.
  std::array<float, weights::kInputs> inputs;
  for (int i = 0; i < weights::kInputs; ++i) {
    const float value = (features[i] - weights::kMean[i]) * weights::kScale[i];
    inputs[i] = std::min(weights::kLimit, std::max(-weights::kLimit, value));
  }
  static_assert(weights::kHidden % 48 == 0);
  add_dense(inputs.data(), weights::kInputs, &weights::kFirst[0][0], weights::kHidden,
            hidden.data());
  std::array<float, weights::kOutputs> out = weights::kOutputBias;
  for (int j = 0; j < weights::kHidden; ++j) {
    const float active = hidden[j] > 0 ? hidden[j] : 0.05F * hidden[j];
    for (int k = 0; k < weights::kOutputs; ++k) out[k] += active * weights::kSecond[j][k];
  }
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
