#pragma once

#include <memory>
#include <string>
#include <vector>

#include "simulate/options.h"
#include "simulate/picture.h"
#include "simulate/world.h"

namespace bole::simulate {

/// One tree as one frame sees it, in the robot frame of that frame with z along gravity: metres and
/// radians (frames of reference: the design's).
struct TreeTruth {
  int id = 0;           ///< the same in all frames of a world
  double x = 0, y = 0;  ///< of the axis at the ground
  double z = 0;         ///< of the ground there, above the ground under the camera
  double diameter = 0;  ///< half a metre up, above the root flare
  double range = 0, bearing = 0;
  double visible = 0;         ///< see measure_tree()
  double foot_visible = 0;    ///< the same for the lowest 0.3 m
  double base_elevation = 0;  ///< of the nearest point of the axis's foot circle, flare included
  double angular_width = 0;   ///< 2 asin(diameter / (2 range))
  double lean_x = 0, lean_y = 0;  ///< shift of the axis within the first metre up
  bool bright = false;
};

struct FrameTruth {
  std::string file;
  std::int64_t utime = 0;  ///< microseconds
  int world = 0;
  Pose pose;
  std::vector<TreeTruth> trees;  ///< all within kReach
};

struct SimFrame {
  Picture picture;
  FrameTruth truth;
  std::vector<int> surfaces;  ///< a pixel's surface number, see view.h; -1 where nothing is seen
};

/// A robot that drives through simulated woods at 10 Hz, and what its camera sees. The same
/// options, seed and camera give the same frames, in whatever order they are asked for.
class Simulator {
 public:
  /// `camera` must outlive the simulator. `frames`: length of the drive.
  Simulator(const SimOptions& options, std::uint64_t seed, const Camera& camera, int frames);

  /// Frame k of the drive; its file is not named yet.
  SimFrame frame(int k);

  static constexpr double kFramePeriod = 0.1;  // seconds

 private:
  void enter_world(int number);

  SimOptions options_;
  std::uint64_t seed_;
  const Camera& camera_;
  PixelRays rays_;
  int frames_per_world_;
  int world_number_ = -1;
  std::vector<Pose> drive_;
  World world_;
  std::unique_ptr<Sunlight> sunlight_;
};

/// A drive of `frames` poses, `period` seconds apart: a steady pace, gentle bends, and a robot that
/// rocks by `attitude` radians (standard deviation).
std::vector<Pose> plan_drive(int frames, double period, double attitude, std::uint64_t seed);

/// `visible`: the share of the trunk's silhouette (a grid over its width at each height and over
/// the tangents of its elevation, from the foot to +25 degrees, or to 10 degrees above a foot that
/// is higher) that nothing else hides, of what lies in the camera's image; leaves hide by their
/// opacity. 0 where less than a quarter of the silhouette lies in the image.
TreeTruth measure_tree(const View& view, int column, const Pose& pose, double ground_z,
                       const Camera& camera);

}  // namespace bole::simulate
