#pragma once

#include <span>

#include "base/image.h"
#include "geometry/camera_model.h"

namespace bole {

/// A point of the plane at distance 1 before a camera in OpenCV's axes: x right, y down.
struct PlanePoint {
  double x = 0, y = 0;
};

/// OpenCV's camera matrix, common to its models: from that plane to pixels.
struct CameraMatrix {
  double focal_x = 0, focal_y = 0;           ///< pixels
  double centre_column = 0, centre_row = 0;  ///< principal point
  double skew = 0;                           ///< pixels to the right for each unit of y

  Pixel pixel(PlanePoint point) const;
  PlanePoint plane_point(Pixel pixel) const;
};

/// Throws std::invalid_argument, naming OpenCV's key, when a number is not finite or 1e9 or more
/// in size, or a focal length or the size is not positive.
void require_sensible(const CameraMatrix& matrix, std::span<const double> distortion,
                      ImageSize size);

}  // namespace bole
