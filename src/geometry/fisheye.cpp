#include "geometry/fisheye.h"

#include <cmath>

#include "geometry/angles.h"
#include "geometry/monotone.h"
#include "geometry/opencv_calibration.h"

namespace bole {

FisheyeModel::FisheyeModel(const Parameters& parameters) : p_(parameters) {
  require_sensible(p_.matrix, p_.distortion, p_.size);
  largest_angle_ = grows_until([this](double theta) { return slope(theta); }, 0.001, kPi);
}

double FisheyeModel::distorted(double theta) const {
  const auto& k = p_.distortion;
  const double t2 = theta * theta;
  return theta * (1 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3]))));
}

double FisheyeModel::slope(double theta) const {
  const auto& k = p_.distortion;
  const double t2 = theta * theta;
  return 1 + t2 * (3 * k[0] + t2 * (5 * k[1] + t2 * (7 * k[2] + t2 * 9 * k[3])));
}

std::optional<Pixel> FisheyeModel::pixel_from_ray(const Vec3& ray) const {
  const double across = std::hypot(ray.x, ray.y);
  const double theta = std::atan2(across, ray.z);
  if (!(theta < largest_angle_)) return std::nullopt;  // also for a ray that is not a number
  if (across == 0) return p_.matrix.pixel({0, 0});
  const double scale = distorted(theta) / across;
  return p_.matrix.pixel({scale * ray.x, scale * ray.y});
}

Vec3 FisheyeModel::ray_from_pixel(Pixel pixel) const {
  const PlanePoint seen = p_.matrix.plane_point(pixel);
  const double radius = std::hypot(seen.x, seen.y);
  if (radius == 0) return {0, 0, 1};
  if (!(radius < distorted(largest_angle_))) return kNoRay;
  const double theta = root_between([&](double t) { return distorted(t) - radius; },
                                    [this](double t) { return slope(t); }, 0, largest_angle_);
  const double scale = std::sin(theta) / radius;
  return {scale * seen.x, scale * seen.y, std::cos(theta)};
}

FisheyeModel parse_fisheye(std::string_view text, const std::string& file, ImageSize size) {
  return read_opencv_calibration(
      text, file, {.model = "fisheye", .fewest_coefficients = 4, .most_coefficients = 4}, size,
      [](const OpencvCalibration& c) {
        FisheyeModel::Parameters p{.matrix = c.matrix, .distortion = {}, .size = c.size};
        std::ranges::copy(c.distortion, p.distortion.begin());
        return FisheyeModel(p);
      });
}

}  // namespace bole
