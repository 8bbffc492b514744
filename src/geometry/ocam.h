#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geometry/camera_model.h"

namespace bole {

/// The omnidirectional camera model of Scaramuzza's OCamCalib toolbox: one effective viewpoint, and
/// a polynomial f that ties the distance rho from the image centre to the ray's slope.
///
/// Own frame: x along the image rows (down), y along the columns (right), z = f(rho), which grows
/// with the radius. With (u, v) = (row, column) - centre and [u v]' = [c d; e 1] [x y]', the ray of
/// a pixel is (x, y, f(rho)), rho = hypot(x, y).
class OcamModel final : public CameraModel {
 public:
  struct Parameters {
    std::vector<double> direct;  ///< a0, a1, ... of f(rho), rho in pixels; a0 < 0
    std::vector<double>
        inverse;  ///< rho as a polynomial of the elevation angle: the file's own fit
    double centre_row = 0, centre_column = 0;
    double c = 1, d = 0, e = 0;  ///< affine distortion
    ImageSize size;
  };

  /// Throws std::invalid_argument when the parameters are not finite, f(0) is not negative, the
  /// affine part is singular, the size is not positive or the centre is outside of the image.
  explicit OcamModel(Parameters parameters);

  ImageSize image_size() const override { return p_.size; }

  /// Solves f(rho) = rho z / hypot(x, y) by safeguarded Newton steps to machine precision, inside
  /// the radii where f(rho) / rho grows (beyond them the polynomial says nothing about the optics).
  std::optional<Pixel> pixel_from_ray(const Vec3& ray) const override;
  Vec3 ray_from_pixel(Pixel pixel) const override;

  /// As pixel_from_ray, by the file's inverse polynomial, which is only a fit to the direct one.
  std::optional<Pixel> pixel_from_ray_by_fit(const Vec3& ray) const;

  const Parameters& parameters() const { return p_; }
  /// The largest radius, in pixels, at which the model is invertible (at most the farthest corner).
  double largest_radius() const { return largest_radius_; }

 private:
  double f(double rho) const;
  double slope_of_f(double rho) const;
  Pixel place(double x, double y) const;
  double find_largest_radius() const;

  Parameters p_;
  double largest_radius_ = 0;
};

/// Reads the text of OCamCalib's calib_results.txt: direct polynomial, inverse polynomial, centre,
/// affine parameters, image size; '#' starts a comment. Throws ConfigError naming `file`.
OcamModel parse_ocam(std::string_view text, const std::string& file);

}  // namespace bole
