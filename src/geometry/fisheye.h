#pragma once

#include <array>
#include <string>
#include <string_view>

#include "geometry/camera_matrix.h"

namespace bole {

/// Kannala and Brandt's fisheye as cv::fisheye has it: a ray at the angle theta from the optical
/// axis falls at theta_d = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8) from the
/// principal point, in the plane before the camera matrix. Beyond a right angle too, where OpenCV's
/// own functions stop.
///
/// Own frame, as in OpenCV: x right in the image, y down, z along the optical axis.
class FisheyeModel final : public CameraModel {
 public:
  struct Parameters {
    CameraMatrix matrix;
    std::array<double, 4> distortion{};  ///< k1 to k4
    ImageSize size;
  };

  /// Throws std::invalid_argument when a number is not finite or a focal length or the size is not
  /// positive.
  explicit FisheyeModel(const Parameters& parameters);

  ImageSize image_size() const override { return p_.size; }
  /// nullopt from the angle on at which theta_d stops growing.
  std::optional<Pixel> pixel_from_ray(const Vec3& ray) const override;
  Vec3 ray_from_pixel(Pixel pixel) const override;

 private:
  double distorted(double theta) const;
  double slope(double theta) const;

  Parameters p_;
  double largest_angle_ = 0;  // radians
};

/// Reads OpenCV's calibration YAML (opencv_calibration.h) with four distortion coefficients.
/// `size`: of the image, for a file that does not say it. Throws ConfigError naming `file`.
FisheyeModel parse_fisheye(std::string_view text, const std::string& file, ImageSize size = {});

}  // namespace bole
