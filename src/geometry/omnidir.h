#pragma once

#include <array>
#include <string>
#include <string_view>

#include "geometry/brown.h"
#include "geometry/camera_matrix.h"

namespace bole {

/// Mei and Rives's unified omnidirectional camera as cv::omnidir has it, for mirrors and fisheyes:
/// a ray meets the unit sphere about the viewpoint and is seen from xi behind it, at
/// (x, y) / (z + xi) in the plane before Brown's distortion and the camera matrix.
///
/// Own frame, as in OpenCV: x right in the image, y down, z along the optical axis.
class OmnidirModel final : public CameraModel {
 public:
  struct Parameters {
    CameraMatrix matrix;
    double xi = 1;                       ///< 0: a perspective camera, 1: a parabolic mirror
    std::array<double, 4> distortion{};  ///< k1, k2, p1, p2
    ImageSize size;
  };

  /// Throws std::invalid_argument when a number is not finite, a focal length or the size is not
  /// positive or xi is negative.
  explicit OmnidirModel(const Parameters& parameters);

  ImageSize image_size() const override { return p_.size; }
  /// nullopt for the part of the sphere that no image holds: where it is seen from inside or
  /// behind its rim (z <= -xi or -1 / xi), and beyond the distortion's reach.
  std::optional<Pixel> pixel_from_ray(const Vec3& ray) const override;
  Vec3 ray_from_pixel(Pixel pixel) const override;

 private:
  Parameters p_;
  BrownDistortion lens_;
  double lowest_z_ = 0;  // of the sphere, that is seen
};

/// Reads OpenCV's calibration YAML (opencv_calibration.h) with xi and four distortion coefficients.
/// `size`: of the image, for a file that does not say it. Throws ConfigError naming `file`.
OmnidirModel parse_omnidir(std::string_view text, const std::string& file, ImageSize size = {});

}  // namespace bole
