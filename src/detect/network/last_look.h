#pragma once

#include "detect/network/foot_patch.h"
#include "detect/network/network.h"

namespace bole {

/// Where exactly a trunk stands: a network that is taught nothing but shifts, on what is left for
/// the last, and sees the picture about the foot beside the features. `logit` is 0: whether it is a
/// trunk is not asked. The weights come from tools/train.
Judgement locate(const TrunkFeatures::Values& features, const FootPatch::Values& foot);

}  // namespace bole
