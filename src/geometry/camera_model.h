#pragma once

#include <cmath>
#include <limits>
#include <optional>

#include "base/image.h"
#include "geometry/rotation.h"

namespace bole {

/// A place in the raw image; pixel centres lie at whole numbers, counted from 0.
struct Pixel {
  double row = 0;
  double column = 0;
};

/// The ray of a pixel to which none leads: not a number.
inline constexpr Vec3 kNoRay{std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::quiet_NaN()};
inline bool is_ray(const Vec3& ray) { return !std::isnan(ray.x); }

/// What a camera's optics do: which ray of the camera's own frame falls on which pixel. Each model
/// says how its frame lies in the image.
class CameraModel {
 public:
  virtual ~CameraModel() = default;

  /// The image that the calibration holds for.
  virtual ImageSize image_size() const = 0;

  /// Where the ray (any length but zero) meets the image plane; the place may lie outside of the
  /// image. nullopt when the model does not map that direction at all, and for kNoRay.
  virtual std::optional<Pixel> pixel_from_ray(const Vec3& ray) const = 0;

  /// The unit ray that falls on `pixel`; kNoRay where the model knows of none.
  virtual Vec3 ray_from_pixel(Pixel pixel) const = 0;
};

}  // namespace bole
