#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "evaluate/annotate.h"
#include "evaluate/drawing.h"
#include "geometry/angles.h"

namespace bole {
namespace {

constexpr int kSide = 1000;     // pixels
constexpr double kMargin = 50;  // pixels around the outermost circle
constexpr int kShift = 4;
const Colour kCircle(92, 86, 80), kInk(220, 216, 210);

class Map {
 public:
  explicit Map(double reach)
      : canvas_(kSide, kSide, cv::Vec3b(28, 26, 24)), scale_((kSide / 2.0 - kMargin) / reach) {}

  cv::Mat3b& canvas() { return canvas_; }
  cv::Point2d place(double bearing, double range) const {
    const double centre = (kSide - 1) / 2.0;
    return {centre - scale_ * range * std::sin(bearing),
            centre - scale_ * range * std::cos(bearing)};
  }

  void draw_circle(cv::Point2d centre, double radius, const Colour& colour, int thickness) {
    const auto fine = [](double value) { return cvRound(value * (1 << kShift)); };
    cv::circle(canvas_, {fine(centre.x), fine(centre.y)}, fine(radius * scale_), colour, thickness,
               cv::LINE_AA, kShift);
  }

 private:
  cv::Mat3b canvas_;
  double scale_;  // pixels a metre
};

void draw_grid(Map& map, Labels& labels, double reach) {
  const cv::Point2d centre = map.place(0, 0);
  for (int bearing = 0; bearing < 360; bearing += 30) {
    draw_line(map.canvas(), {centre, map.place(radians(bearing), reach)}, kCircle);
  }
  for (const double distance : marked_distances(0, reach)) {
    map.draw_circle(centre, distance, kCircle, 1);
  }
  for (const double distance : marked_distances(0, reach)) {
    labels.add(fixed(distance, 0) + " m", map.place(radians(-15), distance), kInk, 0.4);
  }
  for (const auto& [name, bearing] :
       {std::pair{"forward", 0.0}, {"left", 90.0}, {"back", 180.0}, {"right", -90.0}}) {
    labels.add(name, map.place(radians(bearing), reach * 1.04), kInk, 0.5);
  }
  // The robot, its nose forward.
  const double size = reach / 50;
  const std::vector<cv::Point> robot{map.place(0, 2 * size), map.place(radians(140), 1.6 * size),
                                     map.place(radians(-140), 1.6 * size)};
  cv::fillConvexPoly(map.canvas(), robot, kInk, cv::LINE_AA);
}

void draw_tree(Map& map, const Tree& tree, double reach) {
  const Colour colour = colour_of_score(tree.score);
  const double near = std::max<double>(tree.range - tree.range_sigma, 0);
  const double far = std::min<double>(tree.range + tree.range_sigma, reach * 1.1);
  draw_line(map.canvas(), {map.place(tree.bearing, near), map.place(tree.bearing, far)}, colour);
  const cv::Point2d axis = map.place(tree.bearing, tree.range);
  map.draw_circle(axis, tree.diameter / 2.0, colour, cv::FILLED);
  map.draw_circle(axis, tree.diameter / 2.0, {0, 0, 0}, 1);
}

}  // namespace

cv::Mat3b draw_polar_map(const Search& search, std::span<const Tree> trees) {
  const double reach = search.range.high;
  Map map(reach * 1.02);
  Labels labels(map.canvas());
  draw_grid(map, labels, reach);
  for (const Tree& tree : trees) draw_tree(map, tree, reach);
  for (const Tree& tree : trees) {
    const cv::Point2d beside = map.place(tree.bearing, tree.range) + cv::Point2d(0, -8);
    labels.add(fixed(tree.diameter, 2) + " m", beside, colour_of_score(tree.score), 0.36);
  }
  draw_text(map.canvas(), std::to_string(trees.size()) + " trunks, diameters to scale", {16, 28},
            kInk, 0.55);
  draw_text(map.canvas(), "bars: one standard deviation of range", {16, 50}, kCircle * 1.6, 0.45);
  return map.canvas();
}

}  // namespace bole
