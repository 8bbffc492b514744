#include "detect/tracking/assignment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <vector>

namespace bole {
namespace {

TEST(Assignment, FindsTheCheapestPairingAndLeavesDearOnesAlone) {
  Assignment assignment;
  // Greedy would take (0, 0) at 1 and pay 10 for (1, 1).
  const std::vector<double> cost{1, 2, 3, 10};
  EXPECT_THAT(assignment.solve(cost, 2, 2, 100), testing::ElementsAre(1, 0));
  const auto alone = assignment.solve(std::vector<double>{50.0}, 1, 1, 20);
  EXPECT_EQ(alone[0], -1);
  EXPECT_TRUE(assignment.solve({}, 0, 5, 1).empty());
}

TEST(Assignment, AgreesWithTryingEveryPairing) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 30);
  Assignment assignment;
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<double> cost(4 * 5);
    std::ranges::generate(cost, [&] { return uniform(random); });
    const double alone = 12;
    const auto total = [&](std::span<const int> columns) {
      double sum = 0;
      for (int i = 0; i < 4; ++i) sum += columns[i] < 0 ? alone : cost[i * 5 + columns[i]];
      return sum;
    };
    double best = 1e9;
    std::vector<int> columns(4);
    for (int code = 0; code < 6 * 6 * 6 * 6; ++code) {
      int rest = code;
      for (int& c : columns) {
        c = rest % 6 - 1;
        rest /= 6;
      }
      std::set<int> used;
      const bool valid =
          std::ranges::all_of(columns, [&](int c) { return c < 0 || used.insert(c).second; });
      if (valid) best = std::min(best, total(columns));
    }
    EXPECT_NEAR(total(assignment.solve(cost, 4, 5, alone)), best, 1e-9);
  }
}

}  // namespace
}  // namespace bole
