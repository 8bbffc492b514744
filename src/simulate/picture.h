#pragma once

#include <cstdint>
#include <vector>

#include "base/image.h"
#include "simulate/view.h"
#include "warp/camera_files.h"

namespace bole::simulate {

/// A frame, red green blue.
struct Picture {
  ImageSize size;
  std::vector<std::uint8_t> rgb;  ///< row by row, 3 bytes a pixel
};

/// The directions in which a camera's pixels look, in the robot frame; worked out once for a
/// camera.
class PixelRays {
 public:
  explicit PixelRays(const Camera& camera);

  struct Direction {
    float x = 0, y = 0, z = 0;  ///< unit
    float span = 0;  ///< radians that the pixel spans; 0: the camera sees nothing or never looks
    bool seen() const { return span > 0; }
  };
  ImageSize size() const { return size_; }
  const Direction& at(int row, int column) const {
    return directions_[static_cast<std::size_t>(row) * size_.width + column];
  }
  /// How the direction changes from a pixel to the one on its right, and below it.
  Direction step_right(int row, int column) const { return step(row, column, 0, 1); }
  Direction step_down(int row, int column) const { return step(row, column, 1, 0); }

 private:
  Direction step(int row, int column, int down, int right) const;

  ImageSize size_;
  std::vector<Direction> directions_;
};

/// Rays in the world from directions in the robot frame.
class RayCaster {
 public:
  explicit RayCaster(const Pose& pose);
  /// `pixel`: radians that a pixel spans.
  Ray ray(float x, float y, float z, float pixel) const;

 private:
  Mat3 world_from_robot_;
};

/// Draws the view through the camera's pixels, one ray a pixel and more where surfaces border on
/// each other; then light becomes grey levels: vignetting, glare, blur, exposure, gamma, noise.
/// The result follows from the arguments alone. `surfaces`, if given, gets each pixel's surface
/// number (-1: not seen).
Picture draw(const View& view, const Look& look, const PixelRays& rays, const Pose& pose,
             std::uint32_t noise_seed, std::vector<int>* surfaces = nullptr);

}  // namespace bole::simulate
