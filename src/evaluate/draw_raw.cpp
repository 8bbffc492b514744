#include <algorithm>
#include <cmath>
#include <optional>

#include <opencv2/imgproc.hpp>

#include "evaluate/annotate.h"
#include "evaluate/drawing.h"
#include "geometry/angles.h"
#include "geometry/ground.h"

namespace bole {
namespace {

// Draws what lies in directions of the robot frame onto the raw image.
class RawCanvas {
 public:
  RawCanvas(const Camera& camera, const cv::Mat3b& picture)
      : camera_(camera),
        camera_from_robot_(transposed(camera.robot_from_camera)),
        scale_(std::max(1.0, std::ceil(1280.0 / std::max(picture.cols, picture.rows)))) {
    cv::resize(picture, canvas_, {}, scale_, scale_, cv::INTER_CUBIC);
  }

  cv::Mat3b& canvas() { return canvas_; }

  /// Where the direction lies, if the image shows it.
  std::optional<cv::Point2d> place(double bearing, double tangent) const {
    const Vec3 ray{std::cos(bearing), std::sin(bearing), tangent};
    const std::optional<Pixel> pixel = camera_.model->pixel_from_ray(camera_from_robot_ * ray);
    const auto whole = [](double x) { return static_cast<std::int64_t>(std::floor(x + 0.5)); };
    if (!pixel || !shows(whole(pixel->row), whole(pixel->column))) return std::nullopt;
    return cv::Point2d{(pixel->column + 0.5) * scale_ - 0.5, (pixel->row + 0.5) * scale_ - 0.5};
  }

  /// The line through directions (bearing, tangent), bent as the optics bend it and broken where
  /// the image does not show it.
  void draw(cv::Mat3b& onto, const std::vector<cv::Point2d>& directions, const Colour& colour,
            int thickness, bool outlined) const {
    std::vector<cv::Point2d> piece;
    const auto finish = [&] {
      if (piece.size() > 1) draw_line(onto, piece, colour, thickness, outlined);
      piece.clear();
    };
    for (std::size_t k = 0; k + 1 < directions.size(); ++k) {
      const cv::Point2d from = directions[k], to = directions[k + 1];
      const int steps = std::max(1, static_cast<int>(cv::norm(to - from) / 0.02));
      for (int step = k == 0 ? 0 : 1; step <= steps; ++step) {
        const cv::Point2d direction = from + (to - from) * (static_cast<double>(step) / steps);
        if (const auto p = place(direction.x, direction.y)) {
          piece.push_back(*p);
        } else {
          finish();
        }
      }
    }
    finish();
  }

 private:
  bool shows(std::int64_t row, std::int64_t column) const {
    const ImageSize size = camera_.model->image_size();
    if (row < 0 || column < 0 || row >= size.height || column >= size.width) return false;
    return camera_.mask.empty() ||
           camera_.mask[static_cast<std::size_t>(row * size.width + column)] != 0;
  }

  const Camera& camera_;
  Mat3 camera_from_robot_;
  double scale_;
  cv::Mat3b canvas_;
};

void draw_depths(RawCanvas& raw, const Camera& camera) {
  cv::Mat3b lines = raw.canvas().clone();
  for (const double depth : marked_distances(0, camera.config.search.range.high)) {
    const double tangent = ground_tangent(depth, camera.config.mount.height);
    raw.draw(lines, {{-kPi, tangent}, {kPi, tangent}}, kGround, 1, false);
  }
  cv::addWeighted(lines, 0.5, raw.canvas(), 0.5, 0, raw.canvas());
}

void draw_horizon(RawCanvas& raw) {
  raw.draw(raw.canvas(), {{-kPi, 0}, {kPi, 0}}, kHorizon, 1, false);
}

// Where nothing else is written: half left of forward.
void label_lines(const RawCanvas& raw, Labels& labels, const Camera& camera) {
  const double bearing = kPi / 4;
  if (const auto p = raw.place(bearing, 0)) labels.add("horizon", *p, kHorizon, 0.42);
  for (const double depth : marked_distances(0, camera.config.search.range.high)) {
    const double tangent = ground_tangent(depth, camera.config.mount.height);
    if (const auto p = raw.place(bearing, tangent)) {
      labels.add(fixed(depth, 0) + " m", *p, kGround, 0.42);
    }
  }
}

void name_directions(const RawCanvas& raw, Labels& labels, const Camera& camera) {
  // Over the ground nearest to the robot that is seen for certain.
  const double tangent = ground_tangent(1.15 * camera.config.range_min, camera.config.mount.height);
  for (const auto& [name, bearing] :
       {std::pair{"forward", 0.0}, {"left", kPi / 2}, {"back", kPi}, {"right", -kPi / 2}}) {
    if (const auto p = raw.place(bearing, tangent)) labels.add(name, *p, {255, 255, 255}, 0.6);
  }
}

}  // namespace

cv::Mat3b draw_raw(const Camera& camera, const cv::Mat3b& picture, std::span<const Tree> trees) {
  RawCanvas raw(camera, picture);
  draw_depths(raw, camera);
  draw_horizon(raw);
  const double top = std::tan(camera.config.elevation_top);
  for (const Tree& tree : trees) {
    const double left = tree.bearing + tree.angular_width / 2.0;
    const double right = tree.bearing - tree.angular_width / 2.0;
    const double foot = std::tan(tree.base_elevation);
    raw.draw(raw.canvas(), {{left, foot}, {left, top}, {right, top}, {right, foot}, {left, foot}},
             colour_of_score(tree.score), 2, true);
  }
  Labels labels(raw.canvas());
  name_directions(raw, labels, camera);
  for (const Tree& tree : trees) {
    if (const auto p = raw.place(tree.bearing, std::tan(tree.base_elevation))) {
      labels.add(fixed(tree.score, 2), *p, colour_of_score(tree.score), 0.42);
    }
  }
  label_lines(raw, labels, camera);
  return raw.canvas();
}

}  // namespace bole
