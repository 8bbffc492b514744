#include "detect/network/foot_patch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "detect/network/foot_kernels.h"
#include "painted_panorama.h"

namespace bole {
namespace {

using Values = FootPatch::Values;

class FootPatchTest : public testing::Test {
 protected:
  FootPatchTest() {
    for (int i = 0; i < static_cast<int>(log_.size()); ++i)
      log_[i] = std::log(static_cast<float>(i) / 4 + 4);
  }

  Values read(const TrunkShape& shape, bool wraps = true) {
    const PanoramaGeometry& geometry = panorama_.setup().panorama;
    return read_foot_patch(panorama_.view(), wraps, log_.data(), shape, geometry.focal());
  }
  static float at(const Values& values, int row, int strip) {
    return values[row * FootPatch::kAcross + strip];
  }

  // The mean over a strip of one line, by what of each pixel lies within it.
  double brightness(double row, double first, double last) {
    const double at = row - 0.5;
    const int above = static_cast<int>(at);
    double sum = 0;
    for (int x = static_cast<int>(first); x < last; ++x) {
      const double inside = std::min(x + 1.0, last) - std::max<double>(x, first);
      const double low = at - above;
      sum += inside * ((1 - low) * panorama_.at(above, x) + low * panorama_.at(above + 1, x));
    }
    return sum / (last - first);
  }

  PaintedPanorama panorama_{full_panorama(1440, 0.4, 0.9, 1.0)};
  std::array<float, kLogLevels> log_;
};

// A dark trunk of 40 columns that ends at row 220: beside it and below it is brighter.
TEST_F(FootPatchTest, ShowsWhereATrunkEnds) {
  for (int row = 0; row < 220; ++row)
    for (int x = 700; x < 740; ++x) panorama_.at(row, x) = 30;
  const Values values = read({.foot = 220, .left = 700, .right = 740});
  for (int row = 0; row < 12; ++row) {
    EXPECT_NEAR(at(values, row, 5), 0, 0.1);
    EXPECT_GT(at(values, row, 0), 1);
    EXPECT_GT(at(values, row, 9), 1);
  }
  for (int row = 13; row < FootPatch::kRows; ++row) EXPECT_GT(at(values, row, 5), 1);
}

TEST_F(FootPatchTest, TurnsABrightTrunkIntoADarkOne) {
  TrunkShape shape{.foot = 200, .left = 300, .right = 320};
  const Values dark = read(shape);
  shape.dark = false;
  const Values bright = read(shape);
  for (int i = 0; i < FootPatch::kCount; ++i) EXPECT_EQ(bright[i], -dark[i]);
}

// Levels between grey levels, strips between columns and lines between rows, and the lean.
TEST_F(FootPatchTest, IsTheMeanOfEachStrip) {
  const TrunkShape shape{
      .foot = 201.3F, .left = 512.4F, .right = 529.1F, .left_slope = 0.05F, .right_slope = 0.07F};
  const Values values = read(shape);
  const double step = 0.5 * foot_unit(shape, panorama_.setup().panorama.focal());
  const auto expected = [&](int row, int strip) {
    const double down = (row - 11.5) * step;
    const double first = shape.centre() + shape.slope() * down + 0.2 * (strip - 5) * shape.width();
    return std::log(brightness(shape.foot + down, first, first + 0.2 * shape.width()) + 4);
  };
  // But for what is subtracted from all and divides all.
  const double unit = (expected(3, 2) - expected(20, 7)) / (at(values, 3, 2) - at(values, 20, 7));
  for (int row = 0; row < FootPatch::kRows; ++row) {
    for (int strip = 0; strip < FootPatch::kAcross; ++strip) {
      EXPECT_NEAR((at(values, row, strip) - at(values, 3, 2)) * unit,
                  expected(row, strip) - expected(3, 2), 0.01);
    }
  }
}

TEST_F(FootPatchTest, IsTheSameAFullTurnAway) {
  const Values before = read({.foot = 220, .left = -20, .right = 20});
  const Values after = read({.foot = 220, .left = 1420, .right = 1460});
  for (int i = 0; i < FootPatch::kCount; ++i) EXPECT_NEAR(before[i], after[i], 0.01);
}

// Outlines at the borders, wider than the panorama, higher than its first row, lower than its last.
TEST_F(FootPatchTest, ShowsWhatThereIsOfAnOutlineThatLeadsOut) {
  for (const TrunkShape& shape : {TrunkShape{.foot = 9, .left = -30, .right = 2},
                                  TrunkShape{.foot = -90, .left = 10, .right = 30},
                                  TrunkShape{.foot = 900, .left = 0, .right = 1440},
                                  TrunkShape{.foot = 100, .left = 1439, .right = 1439.1F}}) {
    for (const bool wraps : {false, true}) {
      const Values values = read(shape, wraps);
      EXPECT_TRUE(std::all_of(values.begin(), values.end(),
                              [](float value) { return std::abs(value) <= 4; }));
    }
  }
}

}  // namespace
}  // namespace bole
