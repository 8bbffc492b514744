#pragma once

#include <optional>
#include <string>
#include <vector>

#include "warp/warp_table.h"

namespace bole {

/// What a camera.toml amounts to, for the person who wrote it.
struct CameraCheck {
  /// Pixels between where a pixel is and where it comes back to from its own ray, or where the
  /// calibration's own inverse polynomial puts it; over the pixels that are not masked.
  struct Error {
    double mean_px = 0, most_px = 0;
  };
  /// An arc to the left from one bearing to another, radians.
  struct Arc {
    double from = 0, to = 0;
  };
  /// Metres of ground that a row of the panorama is worth at a range, metres.
  struct RowWorth {
    double range = 0, metres = 0;
  };

  std::string model;
  ImageSize image;
  double masked = 0;             ///< share of the image
  Error there_and_back;          ///< of the model's own inverse
  double no_way_back = 0;        ///< share of those pixels to which no ray leads back
  std::optional<Error> inverse;  ///< of the inverse polynomial that OCamCalib's file carries
  PanoramaGeometry panorama;
  double seen = 0;          ///< share of it
  std::vector<Arc> blind;   ///< bearings of the kept part at which nothing is seen
  double highest_seen = 0;  ///< radians, median over bearings of the highest elevation seen
  /// Horizontal distance from which on the ground is seen, over the bearings that see any; p95: the
  /// 95th percentile.
  struct NearestGround {
    double least = 0, median = 0, p95 = 0;
  };
  std::optional<NearestGround> nearest_ground;
  double columns_a_degree = 0;
  double pixels_a_degree = 0;  ///< of the image, along the horizon; 0: it is not seen
  std::vector<RowWorth> row_worth;
  double narrowest_trunk = 0;  ///< columns of the smallest searched trunk at the farthest range
  std::vector<std::string> warnings;  ///< what is likely a mistake, each with what mends it
};

/// Everything but the warnings follows from camera and table; those from all of it.
std::vector<std::string> likely_mistakes(const Camera& camera, const CameraCheck& check);

CameraCheck check_camera(const Camera& camera, const WarpTable& table);

/// One line of JSON; angles in degrees.
std::string to_json(const CameraCheck& check);
/// A few lines for people.
std::string to_text(const CameraCheck& check);

}  // namespace bole
