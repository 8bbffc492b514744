#pragma once

#include <string>
#include <string_view>

#include "geometry/brown.h"
#include "geometry/camera_matrix.h"

namespace bole {

/// The perspective camera with OpenCV's lens distortion.
///
/// Own frame, as in OpenCV: x right in the image, y down, z along the optical axis.
class PinholeModel final : public CameraModel {
 public:
  struct Parameters {
    CameraMatrix matrix;
    BrownDistortion::Coefficients distortion{};
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
  BrownDistortion lens_;
};

/// A camera without distortion whose image spans `horizontal_fov` radians, for photographs without
/// a calibration: the principal point is the image's middle, pixels are square.
PinholeModel pinhole_from_field_of_view(double horizontal_fov, ImageSize size);

/// Reads OpenCV's calibration YAML (opencv_calibration.h) with up to five distortion coefficients.
/// `size`: of the image, for a file that does not say it. Throws ConfigError naming `file`.
PinholeModel parse_pinhole(std::string_view text, const std::string& file, ImageSize size = {});

}  // namespace bole
