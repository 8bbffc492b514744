#pragma once

#include <hwy/highway.h>

#include <cstdint>

namespace bole {

/// Kernels run with this instruction set from now on; with the processor's best where it is 0.
inline void choose_target(std::int64_t target) {
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace bole
