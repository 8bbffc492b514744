#include "geometry/camera_matrix.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace bole {

Pixel CameraMatrix::pixel(PlanePoint point) const {
  return {focal_y * point.y + centre_row, focal_x * point.x + skew * point.y + centre_column};
}

PlanePoint CameraMatrix::plane_point(Pixel pixel) const {
  const double y = (pixel.row - centre_row) / focal_y;
  return {(pixel.column - centre_column - skew * y) / focal_x, y};
}

void require_sensible(const CameraMatrix& matrix, std::span<const double> distortion,
                      ImageSize size) {
  const auto require = [](bool condition, const char* problem) {
    if (!condition) throw std::invalid_argument(problem);
  };
  // Bounded, so that no sum or product of them is not finite.
  const auto sane = [](double value) { return std::abs(value) < 1e9; };
  require(std::ranges::all_of(std::array{matrix.focal_x, matrix.focal_y, matrix.centre_column,
                                         matrix.centre_row, matrix.skew},
                              sane),
          "camera_matrix: a number is huge or not finite");
  require(matrix.focal_x > 0 && matrix.focal_y > 0,
          "camera_matrix: a focal length is not positive");
  require(std::ranges::all_of(distortion, sane),
          "distortion_coefficients: a number is huge or not finite");
  require(size.width > 0 && size.height > 0, "the image size is not positive");
}

}  // namespace bole
