#include <cmath>

#include <opencv2/imgproc.hpp>

#include "evaluate/annotate.h"
#include "evaluate/drawing.h"
#include "evaluate/image_detector.h"
#include "geometry/angles.h"
#include "geometry/ground.h"

namespace bole {
namespace {

constexpr double kScale = 2;

// Where a place of the panorama, its pixel centres at whole numbers, lies in the picture.
cv::Point2d at(double column, double row) {
  return {(column + 0.5) * kScale - 0.5, (row + 0.5) * kScale - 0.5};
}

// What the camera does not see was filled from what it sees: shown darker.
void darken_unseen(cv::Mat3b& canvas, const WarpTable& table) {
  const PanoramaGeometry& panorama = table.panorama();
  const cv::Mat1b seen(panorama.rows, panorama.width,
                       const_cast<std::uint8_t*>(table.seen().pixels.data()));
  cv::Mat1b unseen;
  cv::resize(seen == 0, unseen, canvas.size(), 0, 0, cv::INTER_NEAREST);
  cv::Mat3b dark;
  canvas.convertTo(dark, -1, 0.35);
  dark.copyTo(canvas, unseen);
}

void draw_depths(cv::Mat3b& canvas, Labels& labels, const PanoramaGeometry& panorama,
                 const Camera& camera) {
  cv::Mat3b lines = canvas.clone();
  std::vector<std::pair<double, double>> drawn;  // depth and row
  for (const double depth : marked_distances(0, camera.config.search.range.high)) {
    const double row = panorama.row_of_tangent(ground_tangent(depth, camera.config.mount.height));
    if (row > panorama.rows - 1 || (!drawn.empty() && drawn.back().second - row < 3)) continue;
    draw_line(lines, {at(-0.5, row), at(panorama.width, row)}, kGround);
    drawn.emplace_back(depth, row);
  }
  cv::addWeighted(lines, 0.55, canvas, 0.45, 0, canvas);
  for (const auto& [depth, row] : drawn) {
    labels.add(fixed(depth, 0) + " m", at(14, row + 4), kGround, 0.4);
  }
}

void draw_horizon(cv::Mat3b& canvas, Labels& labels, const PanoramaGeometry& panorama) {
  const double row = panorama.horizon_row();
  if (row < 0 || row > panorama.rows - 1) return;
  draw_line(canvas, {at(-0.5, row), at(panorama.width, row)}, kHorizon);
  labels.add("horizon", at(24, row - 2), kHorizon, 0.4);
}

void name_directions(Labels& labels, const PanoramaGeometry& panorama) {
  for (const auto& [name, bearing] :
       {std::pair{"forward", 0.0}, {"left", kPi / 2}, {"back", kPi}, {"right", -kPi / 2}}) {
    const double column = panorama.column_of_bearing(bearing);
    if (column < -0.5 || column > panorama.width - 0.5) continue;
    labels.add(name, at(column, 10), {255, 255, 255}, 0.45);
  }
}

// The rectangle from the foot to the top of the picture, once more a turn on where it crosses the
// seam.
void draw_trunk(cv::Mat3b& canvas, const PanoramaGeometry& panorama, const TrunkMark& mark) {
  const double centre = panorama.column_of_bearing(mark.bearing);
  const double half = mark.angular_width * panorama.focal() / 2;
  const double foot = panorama.row_of_tangent(std::tan(mark.base_elevation));
  for (const double turn : {-1, 0, 1}) {
    const double column = centre + turn * panorama.columns;
    if (column + half < 0 || column - half > panorama.width - 1) continue;
    draw_line(canvas,
              {at(column - half, -2), at(column - half, foot), at(column + half, foot),
               at(column + half, -2)},
              mark.colour, 2, true);
  }
}

void draw_labels(Labels& labels, const PanoramaGeometry& panorama, const TrunkMark& mark) {
  const double column = panorama.column_of_bearing(mark.bearing);
  double row = panorama.row_of_tangent(std::tan(mark.base_elevation));
  for (const std::string& text : mark.labels) {
    row += 10;
    labels.add(text, at(column, row), mark.colour, 0.42);
  }
}

}  // namespace

TrunkMark mark_of(const Tree& tree) {
  return {tree.bearing,
          tree.angular_width,
          tree.base_elevation,
          colour_of_score(tree.score),
          {fixed(tree.score, 2), fixed(tree.range, 1) + " m"}};
}

cv::Mat3b draw_panorama(const Camera& camera, const WarpTable& table, const cv::Mat3b& picture,
                        std::span<const TrunkMark> marks) {
  const PanoramaGeometry& panorama = table.panorama();
  cv::Mat3b canvas = colour_panorama(table, picture, kScale);
  darken_unseen(canvas, table);
  Labels labels(canvas);
  draw_depths(canvas, labels, panorama, camera);
  draw_horizon(canvas, labels, panorama);
  for (const TrunkMark& mark : marks) draw_trunk(canvas, panorama, mark);
  name_directions(labels, panorama);
  for (const TrunkMark& mark : marks) draw_labels(labels, panorama, mark);
  return canvas;
}

}  // namespace bole
