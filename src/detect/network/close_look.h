#pragma once

#include "detect/network/network.h"
#include "detect/network/trunk_patches.h"

namespace bole {

/// A convolutional network over the patches of a candidate, beside its features: it tells more of
/// the doubtful ones, and takes 25 times as long as `judge`. The weights come from tools/train.
Judgement judge_closely(const TrunkFeatures::Values& features, const TrunkPatches& patches);

}  // namespace bole
