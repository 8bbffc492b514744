// render_frames FOLDER SEED FIRST LAST: draws panoramas of invented woods through invented cameras,
// with truth: frames FIRST to LAST - 1 of the set that SEED gives. Four in five are of the preset
// `varied`, half of those on nearly even ground; the others are of `drive` or without trees.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "geometry/angles.h"
#include "simulate/invented_camera.h"
#include "simulate/noise.h"
#include "simulate/simulator.h"
#include "training_frame.h"
#include "warp/warp_table.h"
#include "warp/warper.h"

namespace bole::train {
namespace {

simulate::SimOptions draw_options(simulate::Random& random) {
  const float kind = random.uniform(0, 1);
  simulate::SimOptions options = simulate::preset(kind < 0.14F   ? "treeless"
                                                  : kind < 0.28F ? "drive"
                                                                 : "varied");
  options.frames_per_world = 1;
  if (random.chance(0.5F)) {
    options.slope = {0, 0.03F};
    options.undulation = {0, 0.05F};
    options.attitude_deg = {0, 0.5F};
  }
  if (random.chance(0.3F)) {
    options.clutter_per_ha = {0, 40};
    options.bushes_per_ha = {0, 100};
    options.foot_cover = {0, 0.3F};
    options.walls = {0, 0};
  }
  return options;
}

TrunkTruth in_panorama(const simulate::TreeTruth& tree, const simulate::Pose& pose, double height) {
  const Mat3 robot_from_level = transposed(rotation_y(pose.pitch) * rotation_x(pose.roll));
  const Vec3 axis = robot_from_level * Vec3{tree.x, tree.y, tree.z - height};
  const double near = std::max(0.1, tree.range - tree.diameter / 2);
  const Vec3 foot = robot_from_level * Vec3{near * std::cos(tree.bearing),
                                            near * std::sin(tree.bearing), tree.z - height};
  return {.bearing = static_cast<float>(std::atan2(axis.y, axis.x)),
          .foot_tangent = static_cast<float>(foot.z / std::hypot(foot.x, foot.y)),
          .angular_width = static_cast<float>(tree.angular_width),
          .range = static_cast<float>(tree.range),
          .diameter = static_cast<float>(tree.diameter),
          .visible = static_cast<float>(tree.visible)};
}

TrainingFrame render(std::uint64_t seed, const std::filesystem::path& camera_folder) {
  simulate::Random random(seed, 40);
  const Camera camera = simulate::invent_camera(camera_folder, seed);
  simulate::Simulator simulator(draw_options(random), seed, camera, 1);
  const simulate::SimFrame frame = simulator.frame(0);

  const WarpTable table = build_warp_table(camera);
  Warper warper(table);
  ImageView image{.format = PixelFormat::rgb24, .size = frame.picture.size, .planes = {}};
  image.planes[0] = {std::as_bytes(std::span(frame.picture.rgb)), 3 * frame.picture.size.width};
  const PanoramaView view = warper.warp(image);

  TrainingFrame result;
  result.geometry = *view.geometry;
  result.height = camera.config.mount.height;
  for (int row = 0; row < result.geometry.rows; ++row)
    result.pixels.insert(result.pixels.end(), view.row(row), view.row(row) + result.geometry.width);
  const SeenMap seen = table.seen();
  result.seen.assign(seen.pixels.begin(), seen.pixels.end());
  result.columns.assign(seen.columns.begin(), seen.columns.end());
  for (const simulate::TreeTruth& tree : frame.truth.trees)
    result.trunks.push_back(in_panorama(tree, frame.truth.pose, result.height));
  return result;
}

}  // namespace
}  // namespace bole::train

int main(int count, char** arguments) {
  if (count != 5) {
    std::fputs("usage: render_frames FOLDER SEED FIRST LAST\n", stderr);
    return 2;
  }
  const std::filesystem::path folder = arguments[1];
  const auto seed = std::strtoull(arguments[2], nullptr, 10);
  const int first = std::atoi(arguments[3]), last = std::atoi(arguments[4]);
  std::filesystem::create_directories(folder);
  for (int i = first; i < last; ++i) {
    char name[16];
    std::snprintf(name, sizeof name, "%06d", i);
    const auto file = folder / (std::string(name) + ".frame");
    if (std::filesystem::exists(file)) continue;
    const auto camera = folder / ("camera_" + std::string(name));
    std::filesystem::create_directories(camera);
    bole::train::render(seed * 1'000'003 + static_cast<unsigned>(i), camera).save(file);
    std::filesystem::remove_all(camera);
  }
  return 0;
}
