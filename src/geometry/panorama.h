#pragma once

#include <algorithm>

#include "geometry/rotation.h"

namespace bole {

/// The gravity-aligned cylinder onto which frames are un-warped. Column j of the full turn looks
/// along bearing pi - 2 pi (j + 0.5) / columns; rows go evenly with the tangent of the elevation in
/// steps of 2 pi / columns, from the top down, so that pixels are square at the horizon, upright
/// trunks are vertical bars and ground at one range is one row.
///
/// A camera that sees less than a full turn keeps `width` columns from `first_column` on (modulo
/// columns). Columns here count within the kept part; rows and columns are continuous, pixel
/// centres at whole numbers.
struct PanoramaGeometry {
  int columns = 1440;    ///< of the full turn
  int first_column = 0;  ///< of the kept part
  int width = 1440;      ///< columns kept
  int rows = 0;
  double top_tangent = 0;  ///< tangent of the elevation at the upper border of row 0

  /// Pixels a radian, and a unit of tangent: the focal length of the cylinder.
  double focal() const;
  /// A full turn is kept, so that the last column neighbours the first.
  bool wraps() const { return width == columns; }

  double tangent_of_row(double row) const;
  double row_of_tangent(double tangent) const;
  /// The row, continuous, of the horizon.
  double horizon_row() const { return row_of_tangent(0); }
  /// The bearing, in [-pi, pi), of a column of the kept part.
  double bearing_of_column(double column) const;
  /// The column of the kept part, in [-0.5, columns - 0.5); beyond `width` when it is not kept.
  double column_of_bearing(double bearing) const;
  /// The direction in the robot frame, not of unit length: its horizontal part is.
  Vec3 ray(double row, double column) const;

  friend bool operator==(const PanoramaGeometry&, const PanoramaGeometry&) = default;
};

/// The column, of `width`, that stands for one beyond the borders: round the turn where the
/// panorama `wraps`, else the outermost.
inline int column_within(int column, int width, bool wraps) {
  return wraps ? (column % width + width) % width : std::clamp(column, 0, width - 1);
}

/// A full turn of `columns` from `elevation_top` radians down to the ground at `range_min` metres
/// under a viewpoint `height` metres up: rows = ceil(focal (tan(elevation_top) + height /
/// range_min)).
PanoramaGeometry full_panorama(int columns, double elevation_top, double range_min, double height);

}  // namespace bole
