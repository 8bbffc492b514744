#include "geometry/ocam.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "base/errors.h"
#include "geometry/monotone.h"

namespace bole {
namespace {

double polynomial(const std::vector<double>& coefficients, double x) {
  return std::accumulate(coefficients.rbegin(), coefficients.rend(), 0.0,
                         [x](double sum, double a) { return sum * x + a; });
}

double farthest_corner(const OcamModel::Parameters& p) {
  const double row = std::max(p.centre_row, p.size.height - 1 - p.centre_row);
  const double column = std::max(p.centre_column, p.size.width - 1 - p.centre_column);
  return std::hypot(row, column);
}

bool all_finite(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double v) { return std::isfinite(v); });
}

}  // namespace

OcamModel::OcamModel(Parameters parameters) : p_(std::move(parameters)) {
  if (p_.size.width <= 0 || p_.size.height <= 0)
    throw std::invalid_argument("image size not positive");
  if (!all_finite(p_.direct) || !all_finite(p_.inverse) ||
      !all_finite({p_.centre_row, p_.centre_column, p_.c, p_.d, p_.e})) {
    throw std::invalid_argument("a number is not finite");
  }
  if (!(p_.centre_row > -1 && p_.centre_row < p_.size.height && p_.centre_column > -1 &&
        p_.centre_column < p_.size.width)) {
    throw std::invalid_argument("the centre lies outside of the image");
  }
  if (p_.direct.empty() || p_.direct[0] >= 0) {
    throw std::invalid_argument("the direct polynomial's first coefficient is not negative");
  }
  if (std::abs(p_.c - p_.d * p_.e) < 1e-6)
    throw std::invalid_argument("affine parameters singular");
  largest_radius_ = find_largest_radius();
}

double OcamModel::f(double rho) const { return polynomial(p_.direct, rho); }

double OcamModel::slope_of_f(double rho) const {
  double sum = 0;
  for (std::size_t k = p_.direct.size() - 1; k > 0; --k) {
    sum = sum * rho + static_cast<double>(k) * p_.direct[k];
  }
  return sum;
}

// f(rho) / rho grows where rho f'(rho) > f(rho); stepping a quarter of a pixel finds its first end.
double OcamModel::find_largest_radius() const {
  const double end = farthest_corner(p_) + 1;
  double rho = 0;
  while (rho < end && rho * slope_of_f(rho) > f(rho)) rho += 0.25;
  return std::min(rho, end);
}

Pixel OcamModel::place(double x, double y) const {
  return {p_.c * x + p_.d * y + p_.centre_row, p_.e * x + y + p_.centre_column};
}

std::optional<Pixel> OcamModel::pixel_from_ray(const Vec3& ray) const {
  const double across = std::hypot(ray.x, ray.y);
  if (across == 0) return ray.z < 0 ? std::optional(place(0, 0)) : std::nullopt;
  const double slope = ray.z / across;
  const auto error = [&](double rho) { return f(rho) - slope * rho; };
  // Also for a ray that is not a number.
  if (!(error(largest_radius_) >= 0)) return std::nullopt;
  const double rho = root_between(
      error, [&](double r) { return slope_of_f(r) - slope; }, 0, largest_radius_);
  return place(rho * ray.x / across, rho * ray.y / across);
}

std::optional<Pixel> OcamModel::pixel_from_ray_by_fit(const Vec3& ray) const {
  const double across = std::hypot(ray.x, ray.y);
  if (across == 0) return place(0, 0);
  const double rho = polynomial(p_.inverse, std::atan2(ray.z, across));
  return place(rho * ray.x / across, rho * ray.y / across);
}

Vec3 OcamModel::ray_from_pixel(Pixel pixel) const {
  const double u = pixel.row - p_.centre_row, v = pixel.column - p_.centre_column;
  const double determinant = p_.c - p_.d * p_.e;
  const double x = (u - p_.d * v) / determinant;
  const double y = (p_.c * v - p_.e * u) / determinant;
  return normalized({x, y, f(std::hypot(x, y))});
}

namespace {

// Hands out the numbers of calib_results.txt one after the other, comments left out.
class NumberReader {
 public:
  NumberReader(std::string_view text, const std::string& file) : rest_(text), file_(file) {}

  double next(const char* what) {
    skip_to_number();
    const auto* const end = std::ranges::find_if(
        rest_, [](unsigned char c) { return std::isspace(c) != 0 || c == '#'; });
    const std::string_view word(rest_.begin(), end);
    if (word.empty()) fail(what, "is missing", "the file has too few numbers");
    double value = 0;
    const char* const first = word.data() + (word.front() == '+' ? 1 : 0);
    const auto [stop, error] = std::from_chars(first, word.data() + word.size(), value);
    if (error != std::errc{} || stop != word.data() + word.size() || !std::isfinite(value)) {
      fail(what, "\"" + std::string(word.substr(0, 40)) + "\" is not a finite number",
           "run the calibration again or restore the file");
    }
    rest_.remove_prefix(word.size());
    return value;
  }

  int next_count(const char* what, int low, int high) {
    const double value = next(what);
    if (value != std::floor(value) || value < low || value > high) {
      fail(what, "is not a whole number",
           "must be from " + std::to_string(low) + " to " + std::to_string(high));
    }
    return static_cast<int>(value);
  }

  std::vector<double> next_list(const char* what, int longest) {
    std::vector<double> values(static_cast<std::size_t>(next_count(what, 1, longest)));
    std::ranges::generate(values, [&] { return next(what); });
    return values;
  }

  [[noreturn]] void fail(const std::string& what, const std::string& problem,
                         const std::string& remedy) const {
    throw ConfigError(file_, what, problem, remedy);
  }

 private:
  void skip_to_number() {
    while (!rest_.empty()) {
      if (rest_.front() == '#') {
        rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size()));
      } else if (std::isspace(static_cast<unsigned char>(rest_.front())) != 0) {
        rest_.remove_prefix(1);
      } else {
        return;
      }
    }
  }

  std::string_view rest_;
  const std::string& file_;
};

}  // namespace

OcamModel parse_ocam(std::string_view text, const std::string& file) {
  NumberReader reader(text, file);
  OcamModel::Parameters p;
  p.direct = reader.next_list("direct polynomial", 20);
  p.inverse = reader.next_list("inverse polynomial", 40);
  p.centre_row = reader.next("centre row");
  p.centre_column = reader.next("centre column");
  p.c = reader.next("affine parameter c");
  p.d = reader.next("affine parameter d");
  p.e = reader.next("affine parameter e");
  p.size.height = reader.next_count("image height", 1, 20000);
  p.size.width = reader.next_count("image width", 1, 20000);
  try {
    return OcamModel(std::move(p));
  } catch (const std::invalid_argument& error) {
    throw ConfigError(file, "", error.what(), "run the calibration again or restore the file");
  }
}

}  // namespace bole
