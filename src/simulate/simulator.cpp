#include "simulate/simulator.h"

#include <cmath>

#include "geometry/angles.h"
#include "simulate/image_files.h"

namespace bole::simulate {

std::vector<Pose> plan_drive(int frames, double period, double attitude, std::uint64_t seed) {
  Random random(seed, 3);
  const double speed = random.uniform(0.6F, 1.4F);
  const std::uint32_t key = random.bits();
  Pose pose;
  pose.heading = random.uniform(0, 6.2831853F);
  std::vector<Pose> drive;
  for (int k = 0; k < frames; ++k) {
    const auto t = static_cast<float>(k * period);
    pose.roll = attitude * 1.8 * noise(t * 1.7F, key);
    pose.pitch = attitude * 1.8 * noise(t * 1.7F, key + 1);
    drive.push_back(pose);
    // At most a turn of 15 degrees a second.
    pose.heading = wrap_angle(pose.heading + period * 0.26 * noise(t * 0.3F, key + 2));
    pose.x += period * speed * std::cos(pose.heading);
    pose.y += period * speed * std::sin(pose.heading);
  }
  return drive;
}

Simulator::Simulator(const SimOptions& options, std::uint64_t seed, const Camera& camera,
                     int frames)
    : options_(options),
      seed_(seed),
      camera_(camera),
      rays_(camera),
      frames_per_world_(options.frames_per_world > 0 ? options.frames_per_world : frames) {}

void Simulator::enter_world(int number) {
  if (number == world_number_) return;
  const std::uint64_t seed = seed_ + 0x9e3779b97f4a7c15ULL * static_cast<std::uint64_t>(number);
  Random random(seed, 4);
  const double attitude =
      radians(random.uniform(options_.attitude_deg.low, options_.attitude_deg.high));
  drive_ = plan_drive(frames_per_world_, kFramePeriod, attitude, seed);
  sunlight_.reset();
  world_ = grow_world(options_, seed, drive_);
  sunlight_ = std::make_unique<Sunlight>(world_);
  world_number_ = number;
}

SimFrame Simulator::frame(int k) {
  enter_world(k / frames_per_world_);
  const Pose& pose = drive_[k % frames_per_world_];
  const auto x = static_cast<float>(pose.x), y = static_cast<float>(pose.y);
  const float ground = world_.terrain.height(x, y);
  const View view(world_, *sunlight_, x, y,
                  ground + static_cast<float>(camera_.config.mount.height));

  SimFrame result;
  result.picture = draw(view, world_.look, rays_, pose,
                        world_.seed + scramble(static_cast<std::uint32_t>(k)), &result.surfaces);
  if (const int quality = world_.look.jpeg_quality; quality < 100) {
    result.picture = through_jpeg(result.picture, quality);
  }
  FrameTruth& truth = result.truth;
  truth.utime = static_cast<std::int64_t>(std::llround(k * kFramePeriod * 1e6));
  truth.world = world_number_;
  truth.pose = pose;
  for (int i = 0; i < world_.trees; ++i) {
    const Column& c = world_.columns[i];
    if (std::hypot(c.x - x, c.y - y) > kReach) continue;
    truth.trees.push_back(measure_tree(view, i, pose, c.z - ground, camera_));
  }
  return result;
}

}  // namespace bole::simulate
