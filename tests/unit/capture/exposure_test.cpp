#include "capture/exposure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace bole {
namespace {

// A scene before a camera that shows a new exposure `delay` frames later.
class Scene {
 public:
  Scene(double light, double gamma, int start_us) : light_(light), gamma_(gamma) {
    pipeline_.fill(start_us);
  }
  double mean() {
    const double exposure_us = pipeline_.front();
    std::rotate(pipeline_.begin(), pipeline_.begin() + 1, pipeline_.end());
    pipeline_.back() = exposure_us_ > 0 ? exposure_us_ : pipeline_[1];
    return 255 * std::pow(std::min(light_ * exposure_us, 1.0), 1 / gamma_);
  }
  void set(int exposure_us) { exposure_us_ = exposure_us; }

 private:
  double light_;
  double gamma_;
  double exposure_us_ = 0;
  std::array<double, 3> pipeline_{};
};

struct Settled {
  double mean;
  int changes_at_the_end;
};

Settled settle(double light, double gamma, ExposureRange range) {
  constexpr int kStartUs = 10'000;
  ExposureController controller(range, kStartUs);
  Scene scene(light, gamma, kStartUs);
  Settled settled{};
  for (int frame = 0; frame < 200; ++frame) {
    settled.mean = scene.mean();
    if (const auto exposure_us = controller.update(settled.mean)) {
      EXPECT_GE(*exposure_us, range.min_us);
      EXPECT_LE(*exposure_us, range.max_us);
      scene.set(*exposure_us);
      if (frame >= 150) ++settled.changes_at_the_end;
    }
  }
  return settled;
}

TEST(Exposure, SettlesOnTheTargetWithoutSwinging) {
  for (const double gamma : {1.0, 2.2}) {
    for (const double light : {1e-5, 4e-5, 1e-3, 2e-3}) {
      const Settled settled = settle(light, gamma, {100, 200'000});
      EXPECT_NEAR(settled.mean, ExposureController::kTarget, 0.12 * ExposureController::kTarget)
          << gamma << " " << light;
      EXPECT_EQ(settled.changes_at_the_end, 0) << gamma << " " << light;
    }
  }
}

TEST(Exposure, StaysWithinWhatTheCameraCan) {
  EXPECT_LT(settle(1e-6, 1, {100, 20'000}).mean, 20);
  EXPECT_EQ(settle(1e-6, 1, {100, 20'000}).changes_at_the_end, 0);
  EXPECT_GT(settle(1, 1, {5'000, 20'000}).mean, 250);
}

TEST(Exposure, LeavesAWellExposedPictureAlone) {
  ExposureController controller({100, 20'000}, 10'000);
  EXPECT_FALSE(controller.update(ExposureController::kTarget * 1.05));
  EXPECT_FALSE(controller.update(ExposureController::kTarget * 0.95));
  EXPECT_TRUE(controller.update(ExposureController::kTarget * 0.8));
}

// A camera that counts exposure in steps shows few of the brightnesses that one might wish for.
TEST(Exposure, SettlesOnTheNearestStepWhereNoneIsRight) {
  constexpr ExposureRange kSteps{100, 20'000, 100};
  for (const double per_us : {0.3, 0.5, 0.7, 0.75, 0.8, 1.0, 1.5}) {
    const auto mean = [&](int exposure_us) { return std::min(per_us * exposure_us, 255.0); };
    const auto error = [&](int exposure_us) {
      return std::abs(mean(exposure_us) - ExposureController::kTarget);
    };
    for (const int start_us : {100, 200, 300, 10'000}) {
      ExposureController controller(kSteps, start_us);
      int exposure_us = start_us;
      int changes_at_the_end = 0;
      for (int frame = 0; frame < 200; ++frame) {
        const std::optional<int> set_us = controller.update(mean(exposure_us));
        if (!set_us) continue;
        EXPECT_EQ(*set_us % 100, 0);
        exposure_us = *set_us / 100 * 100;  // as the driver takes it
        if (frame >= 150) ++changes_at_the_end;
      }
      EXPECT_EQ(changes_at_the_end, 0) << per_us << " from " << start_us;
      const double good_enough = ExposureController::kTolerance * ExposureController::kTarget;
      for (const int other_us : {std::max(exposure_us - 100, 100), exposure_us + 100}) {
        EXPECT_LE(error(exposure_us), std::max(error(other_us), good_enough))
            << per_us << " from " << start_us;
      }
    }
  }
}

TEST(Exposure, TimesAreTheCamerasOwn) {
  constexpr ExposureRange kSteps{300, 1'250, 400};  // 300, 700, 1100
  EXPECT_EQ(kSteps.nearest(0), 300);
  EXPECT_EQ(kSteps.nearest(499), 300);
  EXPECT_EQ(kSteps.nearest(501), 700);
  EXPECT_EQ(kSteps.nearest(1e9), 1'100);
}

TEST(Exposure, IsNoLongerThanAFrame) {
  using std::chrono::milliseconds;
  constexpr ExposureRange kRange{100, 200'000, 100};
  EXPECT_EQ(kRange.held_below(milliseconds(33)).nearest(1e9), 33'000);
  EXPECT_EQ(kRange.held_below(milliseconds(0)).nearest(1e9), 200'000) << "of an unknown rate";
  EXPECT_EQ(kRange.held_below(milliseconds(500)).nearest(1e9), 200'000);
  EXPECT_EQ(kRange.held_below(std::chrono::microseconds(50)).nearest(1e9), 100);
}

TEST(Metering, LeavesAnExposureThatIsLongerThanAFrameThoughItIsRight) {
  CameraSettings settings;
  settings.exposure = CameraSettings::Exposure::metered;
  settings.exposure_us = 50'000;
  Metering metering;
  EXPECT_EQ(metering.start(settings, ExposureRange{100, 200'000, 100}), "");
  metering.tell(ExposureController::kTarget);
  EXPECT_EQ(metering.due(), std::nullopt);
  metering.hold_below(std::chrono::milliseconds(33));
  metering.tell(ExposureController::kTarget);
  EXPECT_EQ(metering.due(), 33'000);
}

TEST(Metering, CountsEachBrightnessOnceAndNoneOfTheOpeningBefore) {
  CameraSettings settings;
  settings.exposure = CameraSettings::Exposure::metered;
  Metering metering;
  metering.start(settings, ExposureRange{100, 200'000, 100});
  metering.tell(10);
  metering.start(settings, ExposureRange{100, 200'000, 100});
  EXPECT_EQ(metering.due(), std::nullopt);
  metering.tell(10);
  EXPECT_TRUE(metering.due());
  EXPECT_EQ(metering.due(), std::nullopt);
}

TEST(Metering, TellsWhenItCannotBeDone) {
  CameraSettings settings;
  Metering metering;
  EXPECT_EQ(metering.start(settings, std::nullopt), "") << "nobody asked for it";
  settings.exposure = CameraSettings::Exposure::metered;
  EXPECT_EQ(metering.start(settings, std::nullopt),
            "exposure = \"metered\": the camera names no exposure times");
  metering.tell(10);
  EXPECT_EQ(metering.due(), std::nullopt);
}

}  // namespace
}  // namespace bole
