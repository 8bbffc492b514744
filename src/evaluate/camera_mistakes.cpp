#include <algorithm>
#include <cmath>
#include <numeric>

#include "evaluate/camera_check.h"
#include "evaluate/drawing.h"
#include "evaluate/mount_keys.h"
#include "geometry/angles.h"
#include "geometry/ground.h"

namespace bole {
namespace {

constexpr double kMuchNearer = 1.15;     // times as near as anything that is seen
constexpr double kOversampled = 1.5;     // columns a pixel
constexpr double kFewColumns = 4;        // of a trunk
constexpr double kPolynomialsApart = 2;  // pixels
constexpr double kComesBack = 0.5;       // pixels
constexpr double kLooksAhead = kPi / 4;
constexpr double kMuchTilt = radians(20);
constexpr double kMuchBlind = radians(30);
constexpr double kLittleSeen = 0.5, kLittleSeenAllRound = 0.8;  // of a panorama

using Warnings = std::vector<std::string>;

void warn_of_optics(const CameraCheck& check, Warnings& warnings) {
  if (check.inverse && check.inverse->mean_px > kPolynomialsApart) {
    warnings.push_back("the calibration's inverse polynomial is " +
                       fixed(check.inverse->mean_px, 1) +
                       " pixels off its direct one on average: one of them is damaged or badly "
                       "fitted (bole uses the direct one)");
  }
  if (check.there_and_back.most_px > kComesBack) {
    warnings.push_back(
        "the calibration's model cannot be inverted over the image: the ray of a pixel leads back "
        "up to " +
        fixed(check.there_and_back.most_px, 1) +
        " pixels away from it; calibrate with views that reach the border, with fewer "
        "coefficients of distortion, or mask the border");
  }
  if (check.no_way_back > 0.01) {
    warnings.push_back(
        "for " + fixed(100 * check.no_way_back, 0) +
        " % of the pixels the calibration leads nowhere: mask them, or calibrate with "
        "views that reach the border");
  }
}

// A camera that looks up without a mirror sees left and right change places against the map.
bool mirrored(const Mount& mount) {
  const auto quarter = [](ImageSide side) {
    switch (side) {
      case ImageSide::up:
        return 0;
      case ImageSide::left:
        return 1;
      case ImageSide::down:
        return 2;
      case ImageSide::right:
        break;
    }
    return 3;
  };
  return (quarter(mount.left) - quarter(mount.forward) + 4) % 4 == 3;
}

void warn_of_mount_all_round(const Mount& mount, Warnings& warnings) {
  if (!mount.centre_looks_down && !mirrored(mount)) {
    warnings.push_back(
        "mount: a camera whose middle sees the sky shows the robot's left on the image's right "
        "when forward is up; forward and left say otherwise, which fits a flipped image or a "
        "mirror below the camera");
  }
  if (std::max(std::abs(mount.roll), std::abs(mount.pitch)) > kMuchTilt) {
    warnings.push_back("mount.roll_deg = " + fixed(degrees(mount.roll), 1) +
                       " and pitch_deg = " + fixed(degrees(mount.pitch), 1) +
                       " are more than a camera that sees all round is tilted: they count from its "
                       "axis upright; centre says whether it looks up or down");
  }
}

// Its axis stands upright, so that it sees all round. A fisheye may be turned to look ahead.
bool is_upright(const CameraConfig& config) {
  const bool ahead =
      config.model == CameraConfig::Model::fisheye && std::abs(config.mount.pitch) > kLooksAhead;
  return looks_all_round(config.model) && !ahead;
}

// Radians of bearing at which nothing is seen, those that the table has left out included.
double blind_bearings(const CameraCheck& check) {
  const PanoramaGeometry& panorama = check.panorama;
  return std::accumulate(check.blind.begin(), check.blind.end(),
                         2 * kPi * (panorama.columns - panorama.width) / panorama.columns,
                         [](double sum, const CameraCheck::Arc& arc) {
                           return sum + std::remainder(arc.to - arc.from - kPi, 2 * kPi) + kPi;
                         });
}

void warn_of_sight(const CameraConfig& config, const CameraCheck& check, Warnings& warnings) {
  const bool all_round = is_upright(config);
  if (check.seen < (all_round ? kLittleSeenAllRound : kLittleSeen)) {
    warnings.push_back("only " + fixed(100 * check.seen, 0) + " % of the panorama is seen: check " +
                       tilt_keys(config) +
                       " first, then the mask, elevation_top_deg and range_min_m");
  }
  if (const double blind = blind_bearings(check); all_round && blind > kMuchBlind) {
    warnings.push_back("nothing is seen at " + fixed(degrees(blind), 0) +
                       " degrees of bearing: check " + tilt_keys(config) +
                       " first, then the mask; if the robot itself stands there, all is well");
  }
}

void warn_of_ground(const CameraConfig& config, const CameraCheck& check, Warnings& warnings) {
  if (check.highest_seen < 0) {
    warnings.push_back("the horizon is not seen: check " + tilt_keys(config));
  }
  if (!check.nearest_ground) {
    warnings.push_back("no ground is seen: check " + tilt_keys(config));
    return;
  }
  const double least = check.nearest_ground->least, median = check.nearest_ground->median;
  if (least > kMuchNearer * config.range_min) {
    warnings.push_back("panorama.range_min_m = " + fixed(config.range_min, 2) +
                       " is nearer than anything the image sees: check " + tilt_keys(config) +
                       " first; if they are right, rows that show nothing cost time, and " +
                       fixed(least, 2) + " would do");
  }
  const Bounds& range = config.search.range;
  if (median <= kMuchNearer * range.low) return;
  const double lowest_row =
      ground_distance(check.panorama.tangent_of_row(check.panorama.rows - 1), config.mount.height);
  const bool cut = median < 1.01 * lowest_row;  // by the panorama, and not by the image
  std::string remedy = "check " + tilt_keys(config) + " first";
  if (cut) {
    remedy = "lower panorama.range_min_m to " + fixed(range.low, 2);
  } else if (median < range.high) {
    remedy += "; if they are right, begin range_m at " + fixed(median, 2);
  }
  warnings.push_back(
      "search.range_m begins at " + fixed(range.low, 2) + ", but the " +
      (cut ? "panorama" : "image") + " shows the ground only from " + fixed(median, 2) +
      " m on: nearer trees have no foot in the picture, and their range is vague; " + remedy);
}

// Columns of a full turn that are so many a degree, as camera.toml takes them.
int columns_of(double columns_a_degree) {
  return static_cast<int>(std::clamp(8 * std::ceil(columns_a_degree * 360 / 8), 64.0, 16384.0));
}

void warn_of_resolution(const CameraConfig& config, const CameraCheck& check, Warnings& warnings) {
  const Bounds& diameter = config.search.diameter;
  const double pixels = check.pixels_a_degree;
  const int enough = columns_of(pixels);
  const bool oversampled =
      pixels > 0 && check.columns_a_degree > kOversampled * pixels && enough < config.columns;
  const bool thin = check.narrowest_trunk < kFewColumns;
  const std::string trunk = "a trunk of " + fixed(diameter.low, 2) + " m";
  const std::string too_many =
      "panorama.columns = " + std::to_string(config.columns) +
      " are more than the image has pixels round the horizon: " + std::to_string(enough) +
      " would show as much in less time";
  // The range at which the image itself gives it just pixels enough.
  const double farthest =
      pixels > 0 ? diameter.low / (2 * std::sin(std::min(kPi, radians(kFewColumns / pixels)) / 2))
                 : 0;
  if (pixels > 0 && farthest < config.search.range.high && (oversampled || thin)) {
    std::string text = "the image resolves " + trunk + " only to " + fixed(farthest, 1) + " m: " +
                       (farthest > config.search.range.low ? "end search.range_m there or " : "") +
                       "raise diameter_m";
    if (oversampled) text += "; " + too_many;
    if (enough > config.columns)
      text += ", and raise panorama.columns to " + std::to_string(enough);
    warnings.push_back(std::move(text));
  } else if (oversampled) {
    warnings.push_back(too_many);
  } else if (thin) {
    const double width = angular_width(diameter.low, config.search.range.high);
    warnings.push_back(trunk + " at " + fixed(config.search.range.high, 0) + " m is " +
                       fixed(check.narrowest_trunk, 1) +
                       " columns wide, too few to be found: raise panorama.columns to " +
                       std::to_string(columns_of(kFewColumns / degrees(width))) +
                       ", or shorten search.range_m");
  }
}

}  // namespace

std::vector<std::string> likely_mistakes(const Camera& camera, const CameraCheck& check) {
  const CameraConfig& config = camera.config;
  Warnings warnings;
  warn_of_optics(check, warnings);
  if (is_upright(config)) warn_of_mount_all_round(config.mount, warnings);
  warn_of_sight(config, check, warnings);
  warn_of_ground(config, check, warnings);
  warn_of_resolution(config, check, warnings);
  return warnings;
}

}  // namespace bole
