#include "simulate/simulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/angles.h"
#include "geometry/fisheye.h"
#include "test_camera.h"

namespace bole::simulate {
namespace {

constexpr const char* kUpright = "height_m = 1.05\nroll_deg = 1.3\npitch_deg = -0.8\nyaw_deg = 4\n";
constexpr const char* kMirrored = "height_m = 1.4\nleft = \"image right\"\nyaw_deg = -20\n";
constexpr const char* kTurned =
    "height_m = 0.8\nforward = \"image left\"\nleft = \"image up\"\npitch_deg = 3\n";

// The direction of a pixel in the robot frame with z along gravity, horizontal part of unit length.
struct Line {
  double bearing, tangent;
};
Line line_of(const Camera& camera, const Pose& pose, int row, int column) {
  const Vec3 ray = rotation_y(pose.pitch) * rotation_x(pose.roll) * camera.robot_from_camera *
                   camera.model->ray_from_pixel({double(row), double(column)});
  return {std::atan2(ray.y, ray.x), ray.z / std::hypot(ray.x, ray.y)};
}

// Checks every pixel that looks at a tree's trunk half a metre up, or just beside it: the surface
// drawn there is the tree's inside of the edges that the truth gives, and not outside.
int count_misplaced_edges(const Camera& camera, const SimFrame& frame, int& checked) {
  const ImageSize size = frame.picture.size;
  const double height = camera.config.mount.height;
  int wrong = 0;
  for (const TreeTruth& t : frame.truth.trees) {
    if (t.visible < 0.999 || t.range < 1.5 || t.range > 7) continue;
    const double x = t.x + 0.5 * t.lean_x, y = t.y + 0.5 * t.lean_y, range = std::hypot(x, y);
    const double half = std::asin(t.diameter / 2 / range), bearing = std::atan2(y, x);
    const double margin = 0.03 * half + 0.0015;
    for (int i = 0; i < size.width * size.height; ++i) {
      if (frame.surfaces[i] < 0) continue;
      const Line line = line_of(camera, frame.truth.pose, i / size.width, i % size.width);
      const double off = std::abs(wrap_angle(line.bearing - bearing));
      const double up = line.tangent * (range - t.diameter / 2) + height - t.z;
      if (off > 1.3 * half || up < 0.45 || up > 0.55 || std::abs(off - half) < margin) continue;
      ++checked;
      wrong += (frame.surfaces[i] == kFirstColumn + t.id) != (off < half);
    }
  }
  return wrong;
}

class EveryMount : public testing::TestWithParam<const char*> {};

TEST_P(EveryMount, TrunkEdgesLieWhereTheTruthSays) {
  const Camera camera = test_camera(640, GetParam());
  SimOptions options;
  options.frames_per_world = 1;
  options.attitude_deg = {1, 2};
  options.crooked_share = {0, 0};
  options.bushes_per_ha = options.clutter_per_ha = options.foot_cover = {0, 0};
  Simulator simulator(options, 11, camera, 6);
  int checked = 0, wrong = 0;
  for (int k = 0; k < 6; ++k) wrong += count_misplaced_edges(camera, simulator.frame(k), checked);
  EXPECT_GT(checked, 300);
  EXPECT_LE(wrong, checked / 200);  // a neighbour may stand just beside
}

INSTANTIATE_TEST_SUITE_P(Mounts, EveryMount, testing::Values(kUpright, kMirrored, kTurned));

TEST(Simulator, TheLowestPixelOfATrunkLiesAtItsBaseElevation) {
  const Camera camera = test_camera(640, kUpright);
  SimOptions options;
  options.frames_per_world = 1;
  options.bushes_per_ha = options.clutter_per_ha = options.foot_cover = {0, 0};
  Simulator simulator(options, 5, camera, 6);
  int feet = 0;
  for (int k = 0; k < 6; ++k) {
    const SimFrame frame = simulator.frame(k);
    for (const TreeTruth& t : frame.truth.trees) {
      if (t.foot_visible < 0.999 || t.range < 1.5 || t.range > 7) continue;
      double lowest = 1;
      const int width = frame.picture.size.width;
      for (int i = 0; i < static_cast<int>(frame.surfaces.size()); ++i) {
        if (frame.surfaces[i] != kFirstColumn + t.id) continue;
        lowest = std::min(
            lowest, std::atan(line_of(camera, frame.truth.pose, i / width, i % width).tangent));
      }
      EXPECT_NEAR(lowest, t.base_elevation, 0.009) << t.range;  // a pixel
      ++feet;
    }
  }
  EXPECT_GT(feet, 6);
}

TEST(Simulator, FramesFollowFromTheSeedWhateverTheOrder) {
  const Camera camera = test_camera(160, kUpright);
  Simulator one(preset("varied"), 3, camera, 3), two(preset("varied"), 3, camera, 3);
  const SimFrame last = one.frame(2);
  const SimFrame first = one.frame(0);
  EXPECT_EQ(two.frame(0).picture.rgb, first.picture.rgb);
  EXPECT_EQ(two.frame(2).picture.rgb, last.picture.rgb);
  EXPECT_NE(first.picture.rgb, last.picture.rgb);
  Simulator other(preset("varied"), 4, camera, 3);
  EXPECT_NE(other.frame(0).picture.rgb, first.picture.rgb);
}

// Mean grey levels over a grid of 4 x 3 parts: what a change of the renderer, meant or not, shows
// in. Not bytes: the mathematical library's last bit differs between processors.
TEST(Simulator, AFrameLooksAsItDid) {
  const Camera camera = test_camera(160, kUpright);
  const Picture picture = Simulator(preset("varied"), 1, camera, 1).frame(0).picture;
  std::array<double, 12> means{};
  for (int row = 0; row < 120; ++row) {
    for (int column = 0; column < 160; ++column) {
      means.at(row / 40 * 4 + column / 40) += picture.rgb[3 * (row * 160 + column) + 1] / 1600.0;
    }
  }
  const std::array<double, 12> golden = {54.1, 113.6, 124.6, 57.7,  89.5,  93.1,
                                         78.2, 97.7,  58.3,  118.9, 118.8, 60.2};
  for (std::size_t i = 0; i < means.size(); ++i) EXPECT_NEAR(means[i], golden[i], 0.5) << i;
}

TEST(Simulator, ADriveIsOneWorldSeenFromPosesATenthOfASecondApart) {
  const Camera camera = test_camera(160, kUpright);
  Simulator simulator(preset("drive"), 8, camera, 20);
  const FrameTruth a = simulator.frame(3).truth, b = simulator.frame(4).truth;
  EXPECT_EQ(b.utime - a.utime, 100000);
  const double step = std::hypot(b.pose.x - a.pose.x, b.pose.y - a.pose.y);
  EXPECT_GT(step, 0.05);
  EXPECT_LT(step, 0.15);
  int same = 0;
  for (const TreeTruth& s : a.trees) {
    for (const TreeTruth& t : b.trees) {
      if (s.id != t.id) continue;
      ++same;
      const auto world = [](const Pose& p, const TreeTruth& tree) {
        return Vec3{p.x + tree.range * std::cos(p.heading + tree.bearing),
                    p.y + tree.range * std::sin(p.heading + tree.bearing), tree.diameter};
      };
      const Vec3 p = world(a.pose, s), q = world(b.pose, t);
      EXPECT_LT(norm({p.x - q.x, p.y - q.y, p.z - q.z}), 1e-4);
    }
  }
  EXPECT_GT(same, 30);
}

TEST(Simulator, TreelessWorldsHaveNoTrees) {
  const Camera camera = test_camera(160, kUpright);
  Simulator simulator(preset("treeless"), 1, camera, 2);
  EXPECT_TRUE(simulator.frame(0).truth.trees.empty());
  EXPECT_TRUE(simulator.frame(1).truth.trees.empty());
}

TEST(Simulator, HiddenTrunksAreMarkedHidden) {
  const Camera camera = test_camera(320, kUpright);
  SimOptions options;
  options.frames_per_world = 1;
  Simulator simulator(options, 2, camera, 3);
  int hidden = 0, open = 0;
  for (int k = 0; k < 3; ++k) {
    const SimFrame frame = simulator.frame(k);
    for (const TreeTruth& t : frame.truth.trees) {
      const auto pixels = std::ranges::count(frame.surfaces, kFirstColumn + t.id);
      if (t.visible == 0) {
        ++hidden;
        EXPECT_LE(pixels, 12) << t.range;
      } else if (t.visible > 0.9 && t.range < 8) {
        ++open;
        EXPECT_GT(pixels, 20) << t.range;
      }
    }
  }
  EXPECT_GT(hidden, 5);
  EXPECT_GT(open, 5);
}

// The corners of a fisheye's image, which no mask need cover.
TEST(PixelRays, APixelToWhichNoRayLeadsLooksNowhere) {
  Camera camera;
  camera.model = std::make_unique<FisheyeModel>(FisheyeModel::Parameters{
      .matrix = {.focal_x = 10, .focal_y = 10, .centre_column = 40, .centre_row = 40},
      .distortion = {},
      .size = {80, 80}});
  camera.mask.assign(std::size_t{80} * 80, 255);
  const PixelRays rays(camera);
  EXPECT_TRUE(rays.at(40, 60).seen());
  EXPECT_FALSE(rays.at(2, 2).seen());
}

TEST(Presets, UnknownNamesAreRefused) { EXPECT_ANY_THROW(preset("jungle")); }

}  // namespace
}  // namespace bole::simulate
