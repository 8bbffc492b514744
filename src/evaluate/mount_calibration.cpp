#include "evaluate/mount_calibration.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "capture/replay/frame_file.h"
#include "detect/trunk_finder.h"
#include "evaluate/drawing.h"
#include "evaluate/mount_keys.h"
#include "geometry/angles.h"
#include "warp/warper.h"

namespace bole {
namespace {

constexpr double kNear = radians(0.2);  // a correction of which part is only chance
constexpr int kMostSteps = 6;           // whole ones, until it is near
constexpr int kAveraged = 4;            // estimates from there on
constexpr double kSettled = 0.3;        // standard deviations: what may be left
constexpr int kFewestTrunks = 8;
constexpr double kVaguest = radians(1);  // standard deviation that is still of use

using Frames = std::vector<std::vector<TiltWitness>>;

// The images; those of no use are found out at the first look and left out from then on.
class Images {
 public:
  explicit Images(std::span<const std::filesystem::path> files)
      : files_(files.begin(), files.end()) {}

  // The witnesses in each image.
  Frames look(const Camera& camera, const std::function<void(int, int)>& progress);
  const std::vector<LeftOut>& left_out() const { return left_out_; }
  // What to add to a complaint, in brackets; empty where every image is of use.
  std::string losses() const;
  std::size_t all() const { return files_.size() + left_out_.size(); }

 private:
  std::vector<std::filesystem::path> files_;
  std::vector<LeftOut> left_out_;
};

Frames Images::look(const Camera& camera, const std::function<void(int, int)>& progress) {
  const WarpTable table = build_warp_table(camera);
  Warper warper(table);
  TrunkFinder finder({.panorama = table.panorama(),
                      .seen = table.seen(),
                      .height = camera.config.mount.height,
                      .search = camera.config.search});
  FrameReader reader(table.image_size());
  FrameSlot slot;
  Frames frames;
  int done = 0;
  const int count = static_cast<int>(files_.size());
  std::erase_if(files_, [&](const std::filesystem::path& file) {
    progress(++done, count);
    try {
      reader.read(file, slot);
      std::vector<TiltWitness> witnesses;
      for (const Trunk& trunk : finder.find(warper.warp(slot.view()))) {
        if (const auto witness = witness_of(trunk, table.panorama())) witnesses.push_back(*witness);
      }
      frames.push_back(std::move(witnesses));
      return false;
    } catch (const std::runtime_error& error) {
      left_out_.push_back({file, error.what()});
      return true;
    }
  });
  return frames;
}

std::string Images::losses() const {
  if (left_out_.empty()) return "";
  const LeftOut& first = left_out_.front();
  return " (of " + std::to_string(all()) + (all() == 1 ? " image " : " images ") +
         std::to_string(left_out_.size()) +
         " could not be used; the first: " + first.file.string() + ": " + first.error + ")";
}

// By how far a variance of the tilt makes an angle of the mount vary: `about` is the bearing
// towards which the ground would rise.
double sigma_towards(const TiltFigure& figure, double about) {
  const cv::Vec2d towards(std::cos(about), std::sin(about));
  return std::sqrt(towards.dot(figure.covariance * towards));
}

// In standard deviations.
double distance(const TiltFigure& figure) {
  return std::sqrt(figure.tilt.dot(figure.covariance.inv() * figure.tilt));
}

Vec3 up_of(const cv::Vec2d& tilt) { return {-tilt[0], -tilt[1], 1}; }

void require_enough(const MountTilt& tilt, double yaw, const Images& images) {
  if (tilt.trunks < kFewestTrunks) {
    throw std::runtime_error("trunks that are seen: " + std::to_string(tilt.trunks) +
                             ", needed: " + std::to_string(kFewestTrunks) +
                             "; take frames in other places of a wood" + images.losses());
  }
  const double pitch = sigma_towards(tilt.both, yaw),
               roll = sigma_towards(tilt.both, yaw + kPi / 2);
  if (std::max(pitch, roll) > kVaguest) {
    throw std::runtime_error("the trunks tell roll to " + fixed(degrees(roll), 1) +
                             " and pitch to " + fixed(degrees(pitch), 1) +
                             " degrees only; take more frames, with trunks on all sides of the "
                             "picture" +
                             images.losses());
  }
}

// What the images show of the mount that a camera has.
struct Evidence {
  Frames frames;
  MountTilt tilt;  // what is left of it
};

Evidence look_at(Images& images, const Camera& camera,
                 const std::function<void(int, int)>& progress) {
  Evidence now{images.look(camera, progress), {}};
  if (now.frames.empty()) {
    throw std::runtime_error("no image is of use; give frames of this camera" + images.losses());
  }
  now.tilt = estimate_mount_tilt(now.frames, camera.config.mount.height);
  require_enough(now.tilt, camera.config.mount.yaw, images);
  return now;
}

std::vector<std::string> doubts(const MountTilt& tilt, const TiltFigure& lean_against_feet) {
  std::vector<std::string> warnings;
  const double left = cv::norm(tilt.both.tilt);
  if (left > kNear && distance(tilt.both) > kSettled) {
    warnings.push_back("the estimate has not settled: the frames still ask for " +
                       fixed(degrees(left), 2) + " degrees more than is printed; take more frames");
  }
  // Three standard deviations are not chance.
  if (distance(lean_against_feet) > 3) {
    warnings.push_back("lean and feet differ by " +
                       fixed(degrees(cv::norm(lean_against_feet.tilt)), 1) +
                       " degrees: the ground slopes, or the wood leans; take frames in several "
                       "places, facing different ways");
  }
  return warnings;
}

}  // namespace

Mount settled(Mount mount, const std::function<cv::Vec2d(const Mount&)>& tilt_under) {
  int averaged = 0;
  for (int round = 1;; ++round) {
    const cv::Vec2d tilt = tilt_under(mount);
    if (averaged > 0 || cv::norm(tilt) <= kNear || round > kMostSteps) ++averaged;
    if (averaged > kAveraged) return mount;
    mount = levelled(mount, up_of(tilt / std::max(1, averaged)));
  }
}

Measured horizon_row_of(const Camera& camera, double pitch_sigma) {
  const auto row = [&](double pitch) {
    Mount mount = camera.config.mount;
    mount.pitch = pitch;
    const auto pixel = camera.model->pixel_from_ray(level_ray_of_forward_camera(mount));
    if (!pixel) {
      throw std::runtime_error("the horizon lies where the lens shows nothing; mend " +
                               tilt_keys(camera.config) + " roughly by hand first");
    }
    return pixel->row;
  };
  const double pitch = camera.config.mount.pitch;
  return {row(pitch), std::abs(row(pitch + pitch_sigma) - row(pitch))};
}

MountCalibration calibrate_mount(Camera& camera, std::span<const std::filesystem::path> images,
                                 std::span<const MeasuredTree> trees,
                                 const std::function<void(int, int)>& progress) {
  Images looked_at(images);
  Evidence evidence;
  const Mount mount = settled(camera.config.mount, [&](const Mount& supposed) {
    remount(camera, supposed);
    evidence = look_at(looked_at, camera, progress);
    return evidence.tilt.both.tilt;
  });
  const MountTilt& tilt = evidence.tilt;
  if (cv::norm(tilt.both.tilt) > kVaguest) {
    throw std::runtime_error("the estimate does not settle; take more frames, or mend " +
                             tilt_keys(camera.config) + " roughly by hand first" +
                             looked_at.losses());
  }
  const double pitch_sigma = sigma_towards(tilt.both, mount.yaw);
  const double roll_sigma = sigma_towards(tilt.both, mount.yaw + kPi / 2) / std::cos(mount.pitch);
  MountCalibration result;
  result.roll = {mount.roll, roll_sigma};
  result.pitch = {mount.pitch, pitch_sigma};
  if (camera.config.horizon_row) result.horizon_row = horizon_row_of(camera, pitch_sigma);
  if (!trees.empty()) {
    result.height = estimate_height(evidence.frames, trees, mount.height, tilt.both.covariance);
  }
  result.lean_against_feet = {tilt.by_lean.tilt - tilt.by_feet.tilt,
                              tilt.by_lean.covariance + tilt.by_feet.covariance};
  result.frames = static_cast<int>(evidence.frames.size());
  result.trunks = tilt.trunks;
  result.left_out = looked_at.left_out();
  result.warnings = doubts(tilt, result.lean_against_feet);
  return result;
}

}  // namespace bole
