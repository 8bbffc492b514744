#pragma once

#include <span>

#include "detect/network/trunk_features.h"

namespace bole {

/// What the network says of a candidate. Shifts lead from the shape that was shown to the trunk.
struct Judgement {
  float logit = 0;                 ///< of the probability that this is a trunk
  float centre_shift = 0;          ///< in widths, to the right
  float log_width = 0;             ///< log of true width over shown width
  float foot_shift = 0;            ///< in foot_unit, down
  float log_sigma[3] = {0, 0, 0};  ///< of the three shifts' standard deviations, same units
};

/// Two hidden layers over the features of a candidate; the weights come from tools/train. Several
/// at a time take less time for each.
void judge(std::span<const TrunkFeatures::Values> features, std::span<Judgement> judgements);
/// One small layer over all features but those about the foot: worth a tenth of the time, where
/// most are no trunks.
void judge_at_a_glance(std::span<const TrunkFeatures::Values> features,
                       std::span<Judgement> judgements);

/// The shape that a judgement corrects `shape` to.
TrunkShape corrected(const TrunkShape& shape, const Judgement& judgement, double focal);

}  // namespace bole
