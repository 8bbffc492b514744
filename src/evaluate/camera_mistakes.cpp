#include <cmath>

#include "evaluate/camera_check.h"
#include "evaluate/drawing.h"
#include "geometry/angles.h"

namespace bole {
namespace {

constexpr double kMuchNearer = 1.15;     // times as near as anything that is seen
constexpr double kOversampled = 1.5;     // columns a pixel
constexpr double kFewColumns = 4;        // of a trunk
constexpr double kPolynomialsApart = 2;  // pixels

using Warnings = std::vector<std::string>;

void warn_of_ground(const CameraConfig& config, const CameraCheck& check, Warnings& warnings) {
  if (check.highest_seen < 0) {
    warnings.push_back(
        "the horizon is not seen: check forward, left, centre, roll_deg and pitch_deg");
  }
  if (!check.nearest_ground) {
    warnings.push_back("no ground is seen: check centre, forward, roll_deg and pitch_deg");
    return;
  }
  const double least = check.nearest_ground->least, median = check.nearest_ground->median;
  if (least > kMuchNearer * config.range_min) {
    warnings.push_back(
        "panorama.range_min_m = " + fixed(config.range_min, 2) +
        " is nearer than anything the image sees: rows that show nothing cost time; " +
        fixed(least, 2) + " would do");
  }
  if (median > kMuchNearer * config.search.range.low) {
    warnings.push_back("search.range_m begins at " + fixed(config.search.range.low, 2) +
                       ", but the ground is seen only from " + fixed(median, 2) +
                       " m on: nearer trees have no foot in the picture, and their range is vague");
  }
}

void warn_of_resolution(const CameraConfig& config, const CameraCheck& check, Warnings& warnings) {
  if (check.pixels_a_degree > 0 && check.columns_a_degree > kOversampled * check.pixels_a_degree) {
    const double columns = 8 * std::ceil(check.pixels_a_degree * 360 / 8);
    warnings.push_back("panorama.columns = " + std::to_string(config.columns) +
                       " are more than the image has pixels round the horizon: " +
                       fixed(columns, 0) + " would show as much in less time");
  }
  if (check.narrowest_trunk < kFewColumns) {
    warnings.push_back("a trunk of " + fixed(config.search.diameter.low, 2) + " m at " +
                       fixed(config.search.range.high, 0) + " m is " +
                       fixed(check.narrowest_trunk, 1) +
                       " columns wide, too few to be found: shorten search.range_m, raise "
                       "diameter_m or, if the image has the pixels, columns");
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

void warn_of_sides(const Mount& mount, Warnings& warnings) {
  if (!mount.centre_looks_down && !mirrored(mount)) {
    warnings.push_back(
        "mount: a camera whose middle sees the sky shows the robot's left on the image's right "
        "when forward is up; forward and left say otherwise, which fits only a flipped image");
  }
}

void warn_of_optics(const CameraCheck& check, Warnings& warnings) {
  if (check.inverse && check.inverse->mean_px > kPolynomialsApart) {
    warnings.push_back("the calibration's inverse polynomial is " +
                       fixed(check.inverse->mean_px, 1) +
                       " pixels off its direct one on average: one of them is damaged or badly "
                       "fitted (bole uses the direct one)");
  }
  if (check.no_way_back > 0.01) {
    warnings.push_back(
        "for " + fixed(100 * check.no_way_back, 0) +
        " % of the pixels the calibration leads nowhere: mask them, or calibrate with "
        "views that reach the border");
  }
  if (check.seen < 0.5) {
    warnings.push_back(
        "only " + fixed(100 * check.seen, 0) +
        " % of the panorama is seen: check the mask, elevation_top_deg and range_min_m");
  }
}

}  // namespace

std::vector<std::string> likely_mistakes(const Camera& camera, const CameraCheck& check) {
  Warnings warnings;
  warn_of_optics(check, warnings);
  if (looks_all_round(camera.config.model)) warn_of_sides(camera.config.mount, warnings);
  warn_of_ground(camera.config, check, warnings);
  warn_of_resolution(camera.config, check, warnings);
  return warnings;
}

}  // namespace bole
