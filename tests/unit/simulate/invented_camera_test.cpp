#include "simulate/invented_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace bole::simulate {
namespace {

class InventedCamera : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) / ("camera" + std::to_string(GetParam()));
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

TEST_P(InventedCamera, MapsEveryPixelOfItsMaskToARayAndBack) {
  const Camera camera = invent_camera(folder_, GetParam());
  const ImageSize size = camera.model->image_size();
  double worst = 0, lowest = 1, highest = -1;
  int seen = 0;
  for (int i = 0; i < size.width * size.height; i += 97) {
    if (camera.mask[i] == 0) continue;
    ++seen;
    const Pixel pixel{double(i / size.width), double(i % size.width)};
    const Vec3 ray = camera.model->ray_from_pixel(pixel);
    const auto back = camera.model->pixel_from_ray(ray);
    ASSERT_TRUE(back);
    worst = std::max(worst, std::hypot(back->row - pixel.row, back->column - pixel.column));
    const double up = (camera.robot_from_camera * ray).z;
    lowest = std::min(lowest, up);
    highest = std::max(highest, up);
  }
  EXPECT_GT(seen, size.width * size.height / 97 / 4);
  EXPECT_LT(worst, 0.01);
  EXPECT_LT(lowest, -0.3);   // it sees the ground
  EXPECT_GT(highest, 0.15);  // and above the horizon
}

INSTANTIATE_TEST_SUITE_P(Seeds, InventedCamera, testing::Range(1, 13));

}  // namespace
}  // namespace bole::simulate
