#pragma once

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cstdint>
#include <string>

#include "support/choose_target.h"

namespace bole {

/// Tests of kernels, run with one instruction set after the other.
class EachTarget : public testing::TestWithParam<std::int64_t> {
 protected:
  EachTarget() { choose_target(GetParam()); }
  ~EachTarget() override { choose_target(0); }
};

inline auto each_target() { return testing::ValuesIn(hwy::SupportedAndGeneratedTargets()); }

inline std::string target_name(const testing::TestParamInfo<std::int64_t>& target) {
  return hwy::TargetName(target.param);
}

}  // namespace bole
