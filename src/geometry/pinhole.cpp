#include "geometry/pinhole.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "base/errors.h"

namespace bole {
namespace {

struct Slopes {  // of a ray against the optical axis: x / z, y / z
  double x, y;
};

// Brown's model as OpenCV writes it.
Slopes distorted(const std::array<double, 5>& k, Slopes s) {
  const double r2 = s.x * s.x + s.y * s.y;
  const double radial = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  return {s.x * radial + 2 * k[2] * s.x * s.y + k[3] * (r2 + 2 * s.x * s.x),
          s.y * radial + k[2] * (r2 + 2 * s.y * s.y) + 2 * k[3] * s.x * s.y};
}

// The slope up to which r (1 + k1 r^2 + k2 r^4 + k3 r^6) still grows.
double largest_invertible_slope(const std::array<double, 5>& k) {
  double r = 0;
  const auto derivative = [&](double r2) {
    return 1 + r2 * (3 * k[0] + r2 * (5 * k[1] + r2 * 7 * k[4]));
  };
  while (r < 20 && derivative(r * r) > 0) r += 0.005;
  return r;
}

}  // namespace

PinholeModel::PinholeModel(const Parameters& parameters)
    : p_(parameters), largest_slope_(largest_invertible_slope(parameters.distortion)) {
  const bool finite = std::isfinite(p_.focal_x + p_.focal_y + p_.centre_column + p_.centre_row) &&
                      std::ranges::all_of(p_.distortion, [](double v) { return std::isfinite(v); });
  if (!finite) throw std::invalid_argument("a number is not finite");
  if (p_.focal_x <= 0 || p_.focal_y <= 0) throw std::invalid_argument("focal length not positive");
  if (p_.size.width <= 0 || p_.size.height <= 0)
    throw std::invalid_argument("image size not positive");
}

std::optional<Pixel> PinholeModel::pixel_from_ray(const Vec3& ray) const {
  if (!(ray.z > 0)) return std::nullopt;
  const Slopes s{ray.x / ray.z, ray.y / ray.z};
  if (!(std::hypot(s.x, s.y) < largest_slope_)) return std::nullopt;
  const Slopes seen = distorted(p_.distortion, s);
  return Pixel{p_.focal_y * seen.y + p_.centre_row, p_.focal_x * seen.x + p_.centre_column};
}

Vec3 PinholeModel::ray_from_pixel(Pixel pixel) const {
  const Slopes seen{(pixel.column - p_.centre_column) / p_.focal_x,
                    (pixel.row - p_.centre_row) / p_.focal_y};
  Slopes s = seen;
  for (int step = 0; step < 100; ++step) {  // fixed point: distortion is a small correction
    const Slopes at = distorted(p_.distortion, s);
    const Slopes error{seen.x - at.x, seen.y - at.y};
    s = {s.x + error.x, s.y + error.y};
    if (std::abs(error.x) + std::abs(error.y) < 1e-14) break;
  }
  return normalized({s.x, s.y, 1});
}

PinholeModel pinhole_from_field_of_view(double horizontal_fov, ImageSize size) {
  const double focal = size.width / 2.0 / std::tan(horizontal_fov / 2);
  return PinholeModel({.focal_x = focal,
                       .focal_y = focal,
                       .centre_column = (size.width - 1) / 2.0,
                       .centre_row = (size.height - 1) / 2.0,
                       .distortion = {},
                       .size = size});
}

namespace {

std::vector<double> matrix(const YAML::Node& root, const char* key, std::size_t low,
                           std::size_t high, const std::string& file) {
  auto values = root[key]["data"].as<std::vector<double>>();
  if (values.size() < low || values.size() > high) {
    throw ConfigError(file, key, "has " + std::to_string(values.size()) + " numbers",
                      "needs " + std::to_string(low) + " to " + std::to_string(high));
  }
  return values;
}

int side(const YAML::Node& root, const char* key, const std::string& file) {
  const int pixels = root[key].as<int>();
  if (pixels < 1 || pixels > 20000) {
    throw ConfigError(file, key, "is " + std::to_string(pixels), "must be from 1 to 20000");
  }
  return pixels;
}

}  // namespace

PinholeModel parse_pinhole(std::string_view text, const std::string& file) {
  // OpenCV's first line, "%YAML:1.0", is not a YAML directive.
  if (text.starts_with('%')) text.remove_prefix(std::min(text.find('\n'), text.size()));
  try {
    const YAML::Node root = YAML::Load(std::string(text));
    const auto k = matrix(root, "camera_matrix", 9, 9, file);
    const auto distortion = matrix(root, "distortion_coefficients", 0, 5, file);
    PinholeModel::Parameters p{
        .focal_x = k[0],
        .focal_y = k[4],
        .centre_column = k[2],
        .centre_row = k[5],
        .distortion = {},
        .size = {side(root, "image_width", file), side(root, "image_height", file)}};
    std::ranges::copy(distortion, p.distortion.begin());
    return PinholeModel(p);
  } catch (const YAML::Exception& error) {
    throw ConfigError(file, "", "is not OpenCV's calibration: " + error.msg,
                      "needs image_width, image_height, camera_matrix, distortion_coefficients");
  } catch (const std::invalid_argument& error) {
    throw ConfigError(file, "", error.what(), "run the calibration again or restore the file");
  }
}

}  // namespace bole
