#include "geometry/pinhole.h"

#include <algorithm>
#include <cmath>

#include "geometry/opencv_calibration.h"

namespace bole {

PinholeModel::PinholeModel(const Parameters& parameters)
    : p_(parameters), lens_(parameters.distortion) {
  require_sensible(p_.matrix, p_.distortion, p_.size);
}

std::optional<Pixel> PinholeModel::pixel_from_ray(const Vec3& ray) const {
  if (!(ray.z > 0)) return std::nullopt;
  const auto seen = lens_.distorted({ray.x / ray.z, ray.y / ray.z});
  return seen ? std::optional(p_.matrix.pixel(*seen)) : std::nullopt;
}

Vec3 PinholeModel::ray_from_pixel(Pixel pixel) const {
  const auto point = lens_.undistorted(p_.matrix.plane_point(pixel));
  return point ? normalized({point->x, point->y, 1}) : kNoRay;
}

PinholeModel pinhole_from_field_of_view(double horizontal_fov, ImageSize size) {
  const double focal = size.width / 2.0 / std::tan(horizontal_fov / 2);
  return PinholeModel({.matrix = {.focal_x = focal,
                                  .focal_y = focal,
                                  .centre_column = (size.width - 1) / 2.0,
                                  .centre_row = (size.height - 1) / 2.0},
                       .distortion = {},
                       .size = size});
}

PinholeModel parse_pinhole(std::string_view text, const std::string& file, ImageSize size) {
  return read_opencv_calibration(
      text, file, {.model = "pinhole", .fewest_coefficients = 0, .most_coefficients = 5}, size,
      [](const OpencvCalibration& c) {
        PinholeModel::Parameters p{.matrix = c.matrix, .distortion = {}, .size = c.size};
        std::ranges::copy(c.distortion, p.distortion.begin());
        return PinholeModel(p);
      });
}

}  // namespace bole
