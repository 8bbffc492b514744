#include "base/histogram.h"

#include <limits>

#include <gtest/gtest.h>

namespace bole {
namespace {

TEST(DurationHistogram, QuantilesAreAtMostAThirtySecondTooLarge) {
  DurationHistogram histogram;
  for (std::int64_t value = 1; value <= 1'000'000; value += 7) histogram.add(value);
  for (const double q : {0.01, 0.5, 0.9, 0.99}) {
    const double exact = q * 1e6;
    EXPECT_GE(static_cast<double>(histogram.quantile(q)), exact - 8) << q;
    EXPECT_LE(static_cast<double>(histogram.quantile(q)), exact * (1 + 1.0 / 32) + 8) << q;
  }
}

TEST(DurationHistogram, SmallValuesAreExact) {
  DurationHistogram histogram;
  for (int value = 0; value < 64; ++value) histogram.add(value);
  EXPECT_EQ(histogram.quantile(0.5), 31);
  EXPECT_EQ(histogram.max(), 63);
}

TEST(DurationHistogram, TakesEveryValue) {
  DurationHistogram histogram;
  EXPECT_EQ(histogram.quantile(0.5), 0);
  histogram.add(-5);
  histogram.add(std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(histogram.quantile(0.5), 0);
  EXPECT_EQ(histogram.quantile(1), std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(histogram.count(), 2);
}

}  // namespace
}  // namespace bole
