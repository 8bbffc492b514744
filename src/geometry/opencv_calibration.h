#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"
#include "geometry/camera_matrix.h"

namespace bole {

/// What the calibration programs of OpenCV and of ROS write.
struct OpencvCalibration {
  CameraMatrix matrix;             ///< camera_matrix
  std::vector<double> distortion;  ///< distortion_coefficients
  double xi = 0;                   ///< of an omnidir camera
  ImageSize size;                  ///< image_width, image_height
};

/// What camera.toml says of the file.
struct ExpectedCalibration {
  std::string_view model;  ///< pinhole, fisheye or omnidir, as camera.toml has it
  std::size_t fewest_coefficients, most_coefficients;
};

/// Parses the YAML. Throws ConfigError naming `file` and the key for whatever is missing, of a
/// wrong size, or of another model than expected. `size`: of the image, for a file that does not
/// say it.
OpencvCalibration parse_opencv_calibration(std::string_view text, const std::string& file,
                                           const ExpectedCalibration& expected, ImageSize size);

/// As above, and makes the model of it; numbers that it refuses become ConfigError too.
template <class Make>
auto read_opencv_calibration(std::string_view text, const std::string& file,
                             const ExpectedCalibration& expected, ImageSize size,
                             const Make& make) {
  try {
    return make(parse_opencv_calibration(text, file, expected, size));
  } catch (const std::invalid_argument& error) {
    throw ConfigError(file, "", error.what(), "run the calibration again or restore the file");
  }
}

}  // namespace bole
