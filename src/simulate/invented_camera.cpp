#include "simulate/invented_camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "base/files.h"
#include "geometry/angles.h"
#include "geometry/ocam.h"
#include "simulate/image_files.h"
#include "simulate/noise.h"

namespace bole::simulate {
namespace {

// What is drawn: lengths in pixels, angles in radians against the plane across the optical axis,
// growing with the radius.
struct Optics {
  ImageSize size;
  double centre_row = 0, centre_column = 0;
  double rim = 0;                     // radius of the imaged disc
  double steepest = 0, flattest = 0;  // what the mask leaves
  bool looks_up = false, mirrored = false;
  std::vector<double> direct;
};

// Least squares: the coefficients of the powers of x whose weighted sum comes closest to y.
std::vector<double> fit(const std::vector<double>& x, const std::vector<double>& y,
                        const std::vector<int>& powers) {
  const std::size_t n = powers.size();
  std::vector<std::vector<double>> rows(n, std::vector<double>(n + 1));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < x.size(); ++k) {
      const double p = std::pow(x[k], powers[i]);
      for (std::size_t j = 0; j < n; ++j) rows[i][j] += p * std::pow(x[k], powers[j]);
      rows[i][n] += p * y[k];
    }
  }
  for (std::size_t i = 0; i < n; ++i) {  // Gauss-Jordan with row exchange
    const auto largest = std::max_element(
        rows.begin() + i, rows.end(),
        [i](const auto& a, const auto& b) { return std::abs(a[i]) < std::abs(b[i]); });
    std::swap(rows[i], *largest);
    for (std::size_t r = 0; r < n; ++r) {
      if (r == i) continue;
      const double k = rows[r][i] / rows[i][i];
      for (std::size_t j = i; j <= n; ++j) rows[r][j] -= k * rows[i][j];
    }
  }
  std::vector<double> result;
  result.reserve(n);
  for (std::size_t i = 0; i < n; ++i) result.push_back(rows[i][n] / rows[i][i]);
  return result;
}

std::vector<double> steps(double low, double high, int count) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) values.push_back(low + (high - low) * i / (count - 1));
  return values;
}

// f(rho) = -k u + ... of a mirror: nearly a parabola that meets the rim at the flattest ray.
std::vector<double> mirror_polynomial(Random& random, double rim, double flattest) {
  const double a0 = -rim * random.uniform(0.3F, 0.5F);
  const double rise = rim * std::tan(flattest) - a0;
  const double cubic = rise * random.uniform(-0.1F, 0.15F);
  return {a0, 0, (rise - cubic) / (rim * rim), cubic / (rim * rim * rim)};
}

// An equidistant fisheye: the angle from the axis grows evenly with the radius.
std::vector<double> fisheye_polynomial(double rim, double flattest) {
  const double angle_per_radius = (kPi / 2 + flattest) / rim;
  const std::vector<double> radii = steps(0.05, 1.02, 60);
  std::vector<double> f;
  f.reserve(radii.size());
  for (const double r : radii) f.push_back(-r / std::tan(r * rim * angle_per_radius));
  const std::vector<double> scaled = fit(radii, f, {0, 2, 3, 4});
  return {scaled[0] * rim, 0, scaled[1] / rim, scaled[2] / (rim * rim),
          scaled[3] / (rim * rim * rim)};
}

Optics draw_optics(Random& random) {
  static constexpr std::array<ImageSize, 6> kSizes = {
      {{640, 480}, {800, 600}, {1024, 768}, {1280, 960}, {1280, 1024}, {1600, 1200}}};
  Optics o;
  o.size = kSizes.at(random.bits() % kSizes.size());
  o.centre_row = 0.5 * o.size.height * random.uniform(0.985F, 1.015F);
  o.centre_column = 0.5 * o.size.width * random.uniform(0.985F, 1.015F);
  o.rim = 0.5 * o.size.height * random.uniform(0.85F, 1);
  const float kind = random.uniform(0, 1);
  if (kind < 0.6F) {
    o.flattest = radians(random.uniform(14, 38));
    o.steepest = radians(-random.uniform(40, 65));
    o.direct = mirror_polynomial(random, o.rim, o.flattest);
    o.mirrored = random.chance(0.6F);
  } else {
    o.looks_up = kind > 0.85F;
    o.flattest = radians(o.looks_up ? random.uniform(22, 40) : random.uniform(12, 30));
    o.steepest = o.looks_up ? -kPi / 2 : radians(-random.uniform(50, 85));
    o.direct = fisheye_polynomial(o.rim, o.flattest);
    // Seen from below left and right change places against the map of the ground.
    o.mirrored = o.looks_up;
  }
  return o;
}

std::string line_of(const std::vector<double>& values) {
  std::string text = std::to_string(values.size());
  for (const double value : values) {
    char number[32];
    (void)std::snprintf(number, sizeof number, " %.9e", value);
    text += number;
  }
  return text + "\n";
}

std::string calibration_text(Random& random, const Optics& o) {
  OcamModel::Parameters p{o.direct, {}, o.centre_row, o.centre_column, 1, 0, 0, o.size};
  p.c = random.uniform(0.9985F, 1.0015F);
  p.d = random.uniform(-0.0006F, 0.0006F);
  p.e = random.uniform(-0.0006F, 0.0006F);
  std::vector<double> elevations, radii;
  for (const double rho : steps(0.02 * o.rim, o.rim, 80)) {
    double f = 0;
    for (auto a = o.direct.rbegin(); a != o.direct.rend(); ++a) f = f * rho + *a;
    elevations.push_back(std::atan2(f, rho));
    radii.push_back(rho);
  }
  char tail[200];
  (void)std::snprintf(tail, sizeof tail, "%.6f %.6f\n%.6f %.6f %.6f\n%d %d\n", p.centre_row,
                      p.centre_column, p.c, p.d, p.e, o.size.height, o.size.width);
  return "# invented, in OCamCalib's form: direct polynomial, inverse polynomial, centre,\n"
         "# affine parameters, height and width\n" +
         line_of(o.direct) + line_of(fit(elevations, radii, {0, 1, 2, 3, 4, 5, 6, 7})) + tail;
}

std::string camera_text(Random& random, const Optics& o) {
  static constexpr std::array<const char*, 4> kSides = {"up", "left", "down", "right"};
  const std::size_t forward = random.bits() % 4;
  const std::size_t left = (forward + (o.mirrored ? 3 : 1)) % 4;
  const double height = random.uniform(0.5F, 1.8F);
  const double top = std::min(27.0, degrees(o.looks_up ? 60.0 : o.flattest));
  const double yaw = random.chance(0.5F) ? random.uniform(-180, 180) : random.uniform(-8, 8);
  // The nearest ground that the mask leaves, or that a wide panorama wants.
  const double down = o.looks_up ? o.flattest : -o.steepest;
  const double nearest = std::max(0.85 * height, 1.02 * height / std::tan(down));
  const double roll = random.uniform(-3, 3), pitch = random.uniform(-3, 3);
  char text[800];
  (void)std::snprintf(
      text, sizeof text,
      "[camera]\nmodel = \"ocam\"\ncalibration = \"calib_results.txt\"\nmask = \"mask.png\"\n\n"
      "[mount]\nheight_m = %.3f\nforward = \"image %s\"\nleft = \"image %s\"\ncentre = \"%s\"\n"
      "roll_deg = %.2f\npitch_deg = %.2f\nyaw_deg = %.2f\n\n"
      "[panorama]\ncolumns = 1440\nelevation_top_deg = %.1f\nrange_min_m = %.2f\n\n"
      "[search]\nrange_m = [1.0, 8.0]\ndiameter_m = [0.2, 0.8]\n",
      height, kSides.at(forward), kSides.at(left), o.looks_up ? "up" : "down", roll, pitch, yaw,
      top, nearest);
  return text;
}

Picture draw_mask(Random& random, const Optics& o, const OcamModel& model) {
  Picture mask{o.size, {}};
  mask.rgb.reserve(static_cast<std::size_t>(o.size.width) * o.size.height * 3);
  const int rods = random.chance(0.3F) ? 1 + static_cast<int>(random.bits() % 3) : 0;
  const double first_rod = random.uniform(0, 6.28F), rod = o.rim * random.uniform(0.004F, 0.02F);
  const std::uint32_t ragged = random.bits();
  for (int row = 0; row < o.size.height; ++row) {
    for (int column = 0; column < o.size.width; ++column) {
      const Pixel pixel{static_cast<double>(row), static_cast<double>(column)};
      const double u = row - o.centre_row, v = column - o.centre_column, rho = std::hypot(u, v);
      const Vec3 ray = model.ray_from_pixel(pixel);
      const double angle = std::atan2(ray.z, std::hypot(ray.x, ray.y));
      const double edge = 0.02 * noise(static_cast<float>(9 * std::atan2(u, v)), ragged);
      bool seen = rho < o.rim && angle < o.flattest && angle > o.steepest + edge;
      for (int k = 0; k < rods; ++k) {
        const double at = first_rod + k * 2 * kPi / rods;
        const double ahead = u * std::cos(at) + v * std::sin(at);
        if (ahead > 0 && std::abs(v * std::cos(at) - u * std::sin(at)) < rod) seen = false;
      }
      mask.rgb.insert(mask.rgb.end(), 3, seen ? 255 : 0);
    }
  }
  return mask;
}

}  // namespace

Camera invent_camera(const std::filesystem::path& folder, std::uint64_t seed) {
  Random random(seed, 7);
  const Optics optics = draw_optics(random);
  const std::string calibration = calibration_text(random, optics);
  const std::string config = camera_text(random, optics);
  const Picture mask = draw_mask(random, optics, parse_ocam(calibration, "calib_results.txt"));
  write_file_atomically(folder / "calib_results.txt", std::as_bytes(std::span(calibration)));
  write_file_atomically(folder / "mask.png", encode_png(mask));
  write_file_atomically(folder / "camera.toml", std::as_bytes(std::span(config)));
  return load_camera(folder / "camera.toml");
}

}  // namespace bole::simulate
