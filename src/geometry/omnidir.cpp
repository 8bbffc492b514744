#include "geometry/omnidir.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "geometry/opencv_calibration.h"

namespace bole {

OmnidirModel::OmnidirModel(const Parameters& parameters)
    : p_(parameters),
      lens_({p_.distortion[0], p_.distortion[1], p_.distortion[2], p_.distortion[3], 0}) {
  require_sensible(p_.matrix, p_.distortion, p_.size);
  if (!(p_.xi >= 0 && p_.xi < 1e9)) {
    throw std::invalid_argument("xi: is negative, huge or not finite");
  }
  // (x, y) / (z + xi) grows with the angle from the axis while 1 + xi z > 0 and z + xi > 0.
  lowest_z_ = p_.xi <= 1 ? -p_.xi : -1 / p_.xi;
}

std::optional<Pixel> OmnidirModel::pixel_from_ray(const Vec3& ray) const {
  const Vec3 on_sphere = normalized(ray);
  if (!(on_sphere.z > lowest_z_)) return std::nullopt;  // also for a ray that is not a number
  const double depth = on_sphere.z + p_.xi;
  const auto seen = lens_.distorted({on_sphere.x / depth, on_sphere.y / depth});
  return seen ? std::optional(p_.matrix.pixel(*seen)) : std::nullopt;
}

Vec3 OmnidirModel::ray_from_pixel(Pixel pixel) const {
  const auto point = lens_.undistorted(p_.matrix.plane_point(pixel));
  if (!point) return kNoRay;
  // The nearer to the image of the two places where (x, y, 1) from the centre of projection meets
  // the sphere.
  const double r2 = point->x * point->x + point->y * point->y;
  const double discriminant = 1 + (1 - p_.xi * p_.xi) * r2;
  if (!(discriminant > 0)) return kNoRay;
  const double depth = (p_.xi + std::sqrt(discriminant)) / (1 + r2);
  return normalized({depth * point->x, depth * point->y, depth - p_.xi});
}

OmnidirModel parse_omnidir(std::string_view text, const std::string& file, ImageSize size) {
  return read_opencv_calibration(
      text, file, {.model = "omnidir", .fewest_coefficients = 4, .most_coefficients = 4}, size,
      [](const OpencvCalibration& c) {
        OmnidirModel::Parameters p{
            .matrix = c.matrix, .xi = c.xi, .distortion = {}, .size = c.size};
        std::ranges::copy(c.distortion, p.distortion.begin());
        return OmnidirModel(p);
      });
}

}  // namespace bole
