#include "geometry/panorama.h"

#include <cmath>

#include "geometry/angles.h"

namespace bole {

double PanoramaGeometry::focal() const { return columns / (2 * kPi); }

double PanoramaGeometry::tangent_of_row(double row) const {
  return top_tangent - (row + 0.5) / focal();
}

double PanoramaGeometry::row_of_tangent(double tangent) const {
  return (top_tangent - tangent) * focal() - 0.5;
}

double PanoramaGeometry::bearing_of_column(double column) const {
  return wrap_angle(kPi - 2 * kPi * (first_column + column + 0.5) / columns);
}

double PanoramaGeometry::column_of_bearing(double bearing) const {
  const double column = (kPi - bearing) * focal() - 0.5 - first_column;
  return column - columns * std::floor((column + 0.5) / columns);
}

Vec3 PanoramaGeometry::ray(double row, double column) const {
  const double bearing = bearing_of_column(column);
  return {std::cos(bearing), std::sin(bearing), tangent_of_row(row)};
}

PanoramaGeometry full_panorama(int columns, double elevation_top, double range_min, double height) {
  PanoramaGeometry panorama{.columns = columns,
                            .first_column = 0,
                            .width = columns,
                            .rows = 0,
                            .top_tangent = std::tan(elevation_top)};
  panorama.rows =
      static_cast<int>(std::ceil(panorama.focal() * (panorama.top_tangent + height / range_min)));
  return panorama;
}

}  // namespace bole
