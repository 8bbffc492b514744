#pragma once

#include <cstdint>

// As in the kernels.
#define HWY_WANT_AVX3_DL
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#include <hwy/highway.h>

#include "support/choose_target.h"

namespace bole {

/// Calls check(name) with the kernels of every instruction set of this processor in turn.
template <class Check>
void for_each_vector_target(Check check) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    choose_target(target);
    check(hwy::TargetName(target));
  }
  choose_target(0);
}

}  // namespace bole
