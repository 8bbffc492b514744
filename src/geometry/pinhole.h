#pragma once

#include <array>
#include <string>
#include <string_view>

#include "geometry/camera_model.h"

namespace bole {

/// The perspective camera with OpenCV's lens distortion.
///
/// Own frame, as in OpenCV: x right in the image, y down, z along the optical axis.
class PinholeModel final : public CameraModel {
 public:
  struct Parameters {
    double focal_x = 0, focal_y = 0;           ///< pixels
    double centre_column = 0, centre_row = 0;  ///< principal point
    std::array<double, 5> distortion{};        ///< k1, k2, p1, p2, k3
    ImageSize size;
  };

  /// Throws std::invalid_argument when a number is not finite or a focal length or the size is not
  /// positive.
  explicit PinholeModel(const Parameters& parameters);

  ImageSize image_size() const override { return p_.size; }
  /// nullopt for rays that do not go forward, or beyond the radius up to which the distortion is
  /// invertible.
  std::optional<Pixel> pixel_from_ray(const Vec3& ray) const override;
  Vec3 ray_from_pixel(Pixel pixel) const override;

  const Parameters& parameters() const { return p_; }

 private:
  Parameters p_;
  double largest_slope_ = 0;  // of a ray against the optical axis
};

/// A camera without distortion whose image spans `horizontal_fov` radians, for photographs without
/// a calibration: the principal point is the image's middle, pixels are square.
PinholeModel pinhole_from_field_of_view(double horizontal_fov, ImageSize size);

/// Reads OpenCV's calibration YAML (image_width, image_height, camera_matrix,
/// distortion_coefficients). Throws ConfigError naming `file`.
PinholeModel parse_pinhole(std::string_view text, const std::string& file);

}  // namespace bole
