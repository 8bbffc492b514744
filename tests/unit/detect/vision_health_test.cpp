#include "detect/vision_health.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "painted_panorama.h"

namespace bole {
namespace {

using Reason = VisionHealth::Reason;

class VisionHealthTest : public testing::Test {
 protected:
  PanoramaGeometry geometry_ = full_panorama(1440, radians(27), 0.9, 1.0);
  PaintedPanorama panorama_{geometry_};
  const std::vector<std::uint8_t> good_ = panorama_.pixels();
  VisionHealth health_{geometry_, panorama_.seen()};
  std::uint32_t frames_ = 0;

  // What is told after `frames` frames of the good view changed by `spoil`, with a sensor's noise.
  Reason after(int frames, const std::function<double(double, int, int)>& spoil) {
    Reason reason = Reason::none;
    for (int k = 0; k < frames; ++k) {
      ++frames_;
      for (int row = 0; row < geometry_.rows; ++row) {
        for (int x = 0; x < geometry_.width; ++x) {
          const std::size_t i = static_cast<std::size_t>(row) * geometry_.width + x;
          const int noise = static_cast<int>(simulate::hash(row, x, frames_) % 3) - 1;
          panorama_.pixels()[i] =
              static_cast<std::uint8_t>(std::clamp(spoil(good_[i], row, x) + noise, 0.0, 255.0));
        }
      }
      reason = health_.observe(panorama_.view());
    }
    return reason;
  }
  static double unspoilt(double grey, int, int) { return grey; }
  static double dark(double grey, int, int) { return 0.03 * grey; }
  static double glaring(double grey, int, int) { return 3 * grey; }
};

TEST_F(VisionHealthTest, IsSilentWhileTheViewIsGood) {
  EXPECT_EQ(after(10, unspoilt), Reason::none);
}

TEST_F(VisionHealthTest, TellsDarknessWithinFiveFramesAndTakesItBack) {
  EXPECT_EQ(after(3, unspoilt), Reason::none);
  EXPECT_EQ(after(5, dark), Reason::dark);
  EXPECT_EQ(after(5, unspoilt), Reason::none);
}

TEST_F(VisionHealthTest, TellsASaturatedView) { EXPECT_EQ(after(5, glaring), Reason::glare); }

TEST_F(VisionHealthTest, TellsAVeiledView) {
  EXPECT_EQ(after(5, [](double grey, int, int) { return 215 + 0.08 * grey; }), Reason::glare);
}

TEST_F(VisionHealthTest, TellsACoveredThird) {
  EXPECT_EQ(after(5, [](double grey, int, int x) { return x < 480 ? 35 : grey; }), Reason::covered);
}

TEST_F(VisionHealthTest, TellsALensThatIsSmearedOverAHalf) {
  // A mean over a wide block stands for a smear.
  const auto smear = [&](double grey, int row, int x) {
    if (x % 480 >= 240) return grey;
    double sum = 0;
    int n = 0;
    for (int i = -12; i <= 12; i += 3) {
      for (int j = -12; j <= 12; j += 3, ++n) {
        const int r = std::clamp(row + i, 0, geometry_.rows - 1);
        sum += good_[static_cast<std::size_t>(r) * geometry_.width + (x + j + 1440) % 1440];
      }
    }
    return sum / n;
  };
  EXPECT_EQ(after(5, smear), Reason::smeared);
}

TEST_F(VisionHealthTest, TellsAFrozenPictureAndForgivesTwins) {
  EXPECT_EQ(after(2, unspoilt), Reason::none);
  EXPECT_EQ(health_.observe(panorama_.view()), Reason::none);
  EXPECT_EQ(health_.observe(panorama_.view()), Reason::none);
  EXPECT_EQ(health_.observe(panorama_.view()), Reason::frozen);
  EXPECT_EQ(after(3, unspoilt), Reason::none);
}

TEST_F(VisionHealthTest, TellsOfTheFirstFrameAlready) { EXPECT_EQ(after(1, dark), Reason::dark); }

TEST_F(VisionHealthTest, BelievesInGoodSightAfterThreeGoodFramesRunning) {
  EXPECT_EQ(after(1, dark), Reason::dark);
  EXPECT_EQ(after(2, unspoilt), Reason::dark);
  EXPECT_EQ(after(1, dark), Reason::dark);
  EXPECT_EQ(after(2, unspoilt), Reason::dark);
  EXPECT_EQ(after(1, unspoilt), Reason::none);
}

TEST_F(VisionHealthTest, TellsOfReasonsThatAlternate) {
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(after(1, dark), Reason::dark);
    EXPECT_EQ(after(1, glaring), Reason::glare);
  }
}

}  // namespace
}  // namespace bole
