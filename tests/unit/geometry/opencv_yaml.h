#pragma once

#include <string>
#include <string_view>

namespace bole {

/// As OpenCV's FileStorage writes them; cameras of 1280 x 960.
inline constexpr std::string_view kFisheyeYaml = R"(%YAML:1.0
---
calibration_time: "Mon Jun  2 10:11:12 2025"
image_width: 1280
image_height: 960
fisheye_model: 1
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 420.5, 0.841, 641.3, 0., 418.2, 478.9, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 4
   cols: 1
   dt: d
   data: [ 0.035, -0.012, 0.0041, -0.0009 ]
)";

inline constexpr std::string_view kOmnidirYaml = R"(%YAML:1.0
---
image_width: 1280
image_height: 960
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 760.4, 0.8, 641.3, 0., 758.9, 478.9, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 1
   cols: 4
   dt: d
   data: [ -0.31, 0.12, 0.0011, -0.0007 ]
xi: 1.35
)";

/// `text` with the first `from` replaced.
inline std::string replaced(std::string_view text, std::string_view from, std::string_view to) {
  std::string result(text);
  return result.replace(result.find(from), from.size(), to);
}

}  // namespace bole
