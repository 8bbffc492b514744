#pragma once

#include <vector>

#include "geometry/camera_config.h"
#include "geometry/panorama.h"

namespace bole {

/// One of the paper's bar filters together with the depth at which it looks for trunks.
///
/// The bar is B(x, y) = exp(-x^2 / (2 s^2)) cos(pi x / s) for whole |x|, |y| <= s: the same in
/// every row. The score of column j is S(j) = sum over rows 0 .. foot_row of (G * B)(i, j) /
/// (s^2 n a) with n = foot_row + 1 and a = foot_distance. (The paper prints x^2 / s for the
/// Gaussian, which leaves no side lobes and thus no contrast: taken as a misprint.)
struct PaperTemplate {
  double foot_distance = 0;  ///< metres, to the visible foot: the depth a
  int foot_row = 0;          ///< of the panorama, where ground at that depth is seen
  double diameter = 0;       ///< metres
  double angular_width = 0;  ///< radians
  double width_px = 0;       ///< s
  std::vector<float> bar;    ///< B(0, .), B(1, .) .. B(reach, .); B(-x, .) = B(x, .)

  int reach() const { return static_cast<int>(bar.size()) - 1; }
  double range() const { return foot_distance + diameter / 2; }
};

/// Five diameters evenly over the searched ones at each whole metre of the searched range (at the
/// near end of a range that contains none), by depth, then by diameter. Depths whose ground line
/// lies below the panorama are left out.
std::vector<PaperTemplate> paper_templates(const PanoramaGeometry& panorama, double height,
                                           const Search& search);

}  // namespace bole
