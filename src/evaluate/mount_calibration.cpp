#include "evaluate/mount_calibration.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "evaluate/image_detector.h"
#include "geometry/angles.h"

namespace bole {
namespace {

constexpr double kSettled = radians(0.05);  // a correction not worth another round
constexpr int kMostRounds = 8;
constexpr int kFewestTrunks = 8;
constexpr double kVaguest = radians(1);      // standard deviation that is still of use
constexpr double kSameBearing = radians(3);  // of a measured tree and what is found there
constexpr double kMostRatio = 1.7;           // of heights, true and supposed
constexpr double kFootSigma = 0.008;         // tangent: where grass and flare let a foot end
constexpr double kGroundSigma = 0.02;        // metres, of ground that is even
constexpr double kTapeSigma = 0.01;          // share of a measured range

using Frames = std::vector<std::vector<TiltWitness>>;

// The witnesses in each image; images of no use are noted and taken out.
Frames look(const Camera& camera, std::vector<std::filesystem::path>& images,
            std::vector<std::string>& unreadable, const std::function<void(int, int)>& progress) {
  const WarpTable table = build_warp_table(camera);
  Warper warper(table);
  TrunkFinder finder({.panorama = table.panorama(),
                      .seen = table.seen(),
                      .height = camera.config.mount.height,
                      .search = camera.config.search});
  Frames frames;
  int done = 0;
  const int all = static_cast<int>(images.size());
  std::erase_if(images, [&](const std::filesystem::path& image) {
    progress(++done, all);
    try {
      const cv::Mat3b picture = read_picture(image);
      std::vector<TiltWitness> witnesses;
      for (const Trunk& trunk : finder.find(warper.warp(view_of(picture)))) {
        if (const auto witness = witness_of(trunk, table.panorama())) witnesses.push_back(*witness);
      }
      frames.push_back(std::move(witnesses));
      return false;
    } catch (const std::runtime_error& error) {
      unreadable.push_back(image.string() + ": " + error.what());
      return true;
    }
  });
  return frames;
}

// By how far a variance of the tilt makes an angle of the mount vary: `about` is the bearing
// towards which the ground would rise.
double sigma_towards(const TiltFigure& figure, double about) {
  const cv::Vec2d towards(std::cos(about), std::sin(about));
  return std::sqrt(towards.dot(figure.covariance * towards));
}

Vec3 up_of(const cv::Vec2d& tilt) { return {-tilt[0], -tilt[1], 1}; }

double median(std::vector<double> values) {
  std::ranges::sort(values);
  const auto n = values.size();
  return (values[(n - 1) / 2] + values[n / 2]) / 2;
}

[[noreturn]] void refuse(const char* form, double a, double b = 0) {
  char text[300];
  (void)std::snprintf(text, sizeof text, form, a, b);
  throw std::runtime_error(text);
}

void require_enough(const MountTilt& tilt, double yaw) {
  if (tilt.trunks < kFewestTrunks) {
    refuse("%.0f trunks are seen, %.0f are needed; take frames in other places of a wood",
           tilt.trunks, kFewestTrunks);
  }
  const double pitch = sigma_towards(tilt.both, yaw),
               roll = sigma_towards(tilt.both, yaw + kPi / 2);
  if (std::max(pitch, roll) > kVaguest) {
    refuse(
        "the trunks tell roll to %.1f and pitch to %.1f degrees only; take more frames, with "
        "trunks on all sides of the picture",
        degrees(roll), degrees(pitch));
  }
}

Measured horizon_of(const Camera& camera, double pitch_sigma) {
  const auto row = [&](double pitch) {
    Mount mount = camera.config.mount;
    mount.pitch = pitch;
    const auto pixel = camera.model->pixel_from_ray(level_ray_of_forward_camera(mount));
    if (!pixel) {
      throw std::runtime_error(
          "the horizon lies where the lens shows nothing; mend horizon_row and roll_deg roughly by "
          "hand first");
    }
    return pixel->row;
  };
  const double pitch = camera.config.mount.pitch;
  return {row(pitch), std::abs(row(pitch + pitch_sigma) - row(pitch))};
}

// The true height over the supposed one, if this is the tree.
double height_ratio(const TiltWitness& witness, const MeasuredTree& tree, double height) {
  const TrunkSight& sight = witness.sight;
  return tree.range * sight.down * (1 - std::sin(sight.angular_width / 2)) / height;
}

// The nearest in bearing of those that can be the tree.
std::optional<TiltWitness> found(const std::vector<TiltWitness>& frame, const MeasuredTree& tree,
                                 double height) {
  std::optional<TiltWitness> nearest;
  double least = kSameBearing;
  for (const TiltWitness& witness : frame) {
    const double off = std::abs(wrap_angle(witness.bearing - tree.bearing));
    const double ratio = height_ratio(witness, tree, height);
    if (off >= least || ratio < 1 / kMostRatio || ratio > kMostRatio) continue;
    least = off;
    nearest = witness;
  }
  return nearest;
}

// As one tree has it, in the median over frames.
Measured height_ratio(std::span<const std::vector<TiltWitness>> frames, const MeasuredTree& tree,
                      double height, double tilt_sigma) {
  std::vector<double> ratios, downs;
  for (const std::vector<TiltWitness>& frame : frames) {
    if (const auto witness = found(frame, tree, height)) {
      ratios.push_back(height_ratio(*witness, tree, height));
      downs.push_back(witness->sight.down);
    }
  }
  if (ratios.empty()) {
    refuse(
        "no trunk is found within 3 degrees of bearing %.1f at some %.1f m; measure one that "
        "bolectl detect finds",
        degrees(tree.bearing), tree.range);
  }
  return {median(ratios), std::hypot(std::hypot(kFootSigma, tilt_sigma) / median(downs),
                                     kGroundSigma / height, kTapeSigma)};
}

}  // namespace

Measured estimate_height(std::span<const std::vector<TiltWitness>> frames,
                         std::span<const MeasuredTree> trees, double height, double tilt_sigma) {
  std::vector<double> ratios;
  double variance = 0;  // of their mean, which a median comes close to
  const auto count = static_cast<double>(trees.size());
  for (const MeasuredTree& tree : trees) {
    const Measured ratio = height_ratio(frames, tree, height, tilt_sigma);
    ratios.push_back(ratio.value);
    variance += ratio.sigma * ratio.sigma / (count * count);
  }
  const double ratio = median(ratios);
  return {height * ratio, height * ratio * std::sqrt(variance)};
}

MountCalibration calibrate_mount(Camera& camera, std::span<const std::filesystem::path> images,
                                 std::span<const MeasuredTree> trees,
                                 const std::function<void(int, int)>& progress) {
  std::vector<std::filesystem::path> left(images.begin(), images.end());
  MountCalibration result;
  MountTilt tilt;
  Frames frames;
  double correction = 1;
  for (int round = 0; round < kMostRounds && correction > kSettled; ++round) {
    frames = look(camera, left, result.unreadable, progress);
    if (frames.empty())
      throw std::runtime_error("no image can be read; give frames of this camera");
    tilt = estimate_mount_tilt(frames, camera.config.mount.height);
    require_enough(tilt, camera.config.mount.yaw);
    correction = cv::norm(tilt.both.tilt);
    remount(camera, levelled(camera.config.mount, up_of(tilt.both.tilt)));
  }
  if (correction > kVaguest) {
    throw std::runtime_error(
        "the estimate does not settle; take more frames, or mend roll_deg and "
        "pitch_deg roughly by hand first");
  }
  const Mount& mount = camera.config.mount;
  const double pitch_sigma = sigma_towards(tilt.both, mount.yaw);
  const double roll_sigma = sigma_towards(tilt.both, mount.yaw + kPi / 2) / std::cos(mount.pitch);
  result.roll = {mount.roll, roll_sigma};
  result.pitch = {mount.pitch, pitch_sigma};
  result.lean_against_feet = {tilt.by_lean.tilt - tilt.by_feet.tilt,
                              tilt.by_lean.covariance + tilt.by_feet.covariance};
  if (camera.config.horizon_row) result.horizon_row = horizon_of(camera, pitch_sigma);
  result.height = trees.empty() ? Measured{mount.height, 0}
                                : estimate_height(frames, trees, mount.height,
                                                  std::sqrt(cv::trace(tilt.both.covariance) / 2));
  result.frames = static_cast<int>(frames.size());
  result.trunks = tilt.trunks;
  return result;
}

}  // namespace bole
