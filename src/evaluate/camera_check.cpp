#include "evaluate/camera_check.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "evaluate/figures.h"
#include "geometry/angles.h"
#include "geometry/ground.h"
#include "geometry/ocam.h"

namespace bole {
namespace {

// Sums up distances between pixels.
class ErrorSum {
 public:
  void add(Pixel a, Pixel b) {
    const double off = std::hypot(a.row - b.row, a.column - b.column);
    sum_ += off;
    most_ = std::max(most_, off);
    ++count_;
  }
  CameraCheck::Error error() const { return {sum_ / std::max(1, count_), most_}; }
  int count() const { return count_; }

 private:
  double sum_ = 0, most_ = 0;
  int count_ = 0;
};

// Every fourth pixel of every fourth row tells as much as all of them.
void check_model(const Camera& camera, CameraCheck& check) {
  constexpr int kStep = 4;
  const auto* const ocam = dynamic_cast<const OcamModel*>(camera.model.get());
  ErrorSum back, inverse;
  int looked_at = 0;
  for (int row = 0; row < check.image.height; row += kStep) {
    for (int column = 0; column < check.image.width; column += kStep) {
      const auto index = static_cast<std::size_t>(row) * check.image.width + column;
      if (!camera.mask.empty() && camera.mask[index] == 0) continue;
      ++looked_at;
      const Pixel pixel{static_cast<double>(row), static_cast<double>(column)};
      const Vec3 ray = camera.model->ray_from_pixel(pixel);
      const auto again = camera.model->pixel_from_ray(ray);
      if (!again) continue;
      back.add(pixel, *again);
      if (ocam != nullptr) {
        if (const auto fitted = ocam->pixel_from_ray_by_fit(ray)) inverse.add(pixel, *fitted);
      }
    }
  }
  check.there_and_back = back.error();
  check.no_way_back = 1 - 1.0 * back.count() / std::max(1, looked_at);
  if (ocam != nullptr) check.inverse = inverse.error();
}

double share_of(std::span<const std::uint8_t> pixels, bool wanted) {
  const auto count = std::ranges::count_if(pixels, [&](auto p) { return (p != 0) == wanted; });
  return static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(1, pixels.size()));
}

// Runs of columns of which nothing is seen, from the right so that bearings grow.
std::vector<CameraCheck::Arc> blind_arcs(const PanoramaGeometry& panorama, const SeenMap& seen) {
  std::vector<CameraCheck::Arc> arcs;
  for (int j = panorama.width - 1; j >= 0; --j) {
    if (!seen.columns[j].empty()) continue;
    const double from = panorama.bearing_of_column(j + 0.5);
    while (j > 0 && seen.columns[j - 1].empty()) --j;
    arcs.push_back({from, panorama.bearing_of_column(j - 0.5)});
  }
  // One that goes on across the seam.
  if (panorama.wraps() && arcs.size() > 1 && seen.columns.front().empty() &&
      seen.columns.back().empty()) {
    arcs.front().from = arcs.back().from;
    arcs.pop_back();
  }
  return arcs;
}

void check_sight(const Camera& camera, const WarpTable& table, CameraCheck& check) {
  const PanoramaGeometry& panorama = check.panorama;
  const SeenMap seen = table.seen();
  check.seen = share_of(seen.pixels, true);
  check.blind = blind_arcs(panorama, seen);
  std::vector<double> tops, nearest;
  for (const SeenRows& rows : seen.columns) {
    if (rows.empty()) continue;
    tops.push_back(std::atan(panorama.tangent_of_row(rows.first)));
    const double lowest = panorama.tangent_of_row(rows.last - 1);
    if (lowest < 0) nearest.push_back(ground_distance(lowest, camera.config.mount.height));
  }
  check.highest_seen = *median(std::move(tops));
  if (nearest.empty()) return;
  std::ranges::sort(nearest);
  const double p95 = nearest[(nearest.size() - 1) * 95 / 100];
  check.nearest_ground = {nearest.front(), *median(nearest), p95};
}

// Along the horizon, in steps of half a degree.
double pixels_a_degree(const Camera& camera) {
  constexpr int kSteps = 720;
  const Mat3 camera_from_robot = transposed(camera.robot_from_camera);
  const auto place = [&](int step) -> std::optional<Pixel> {
    const double bearing = 2 * kPi * step / kSteps;
    const auto pixel = camera.model->pixel_from_ray(camera_from_robot *
                                                    Vec3{std::cos(bearing), std::sin(bearing), 0});
    const ImageSize size = camera.model->image_size();
    const bool shown = pixel && pixel->row >= 0 && pixel->column >= 0 &&
                       pixel->row <= size.height - 1 && pixel->column <= size.width - 1;
    return shown ? pixel : std::nullopt;
  };
  double length = 0;
  int steps = 0;
  for (int step = 0; step < kSteps; ++step) {
    const auto from = place(step), to = place(step + 1);
    if (!from || !to) continue;
    length += std::hypot(to->row - from->row, to->column - from->column);
    ++steps;
  }
  return steps == 0 ? 0 : length / (steps * 360.0 / kSteps);
}

void check_resolution(const Camera& camera, CameraCheck& check) {
  const double focal = check.panorama.focal(), height = camera.config.mount.height;
  check.columns_a_degree = check.panorama.columns / 360.0;
  check.pixels_a_degree = pixels_a_degree(camera);
  // range = height / tangent, so that d range = range^2 / height d tangent.
  for (const double range : {2.0, 4.0, 8.0}) {
    check.row_worth.push_back({range, range * range / (height * focal)});
  }
  const Search& search = camera.config.search;
  check.narrowest_trunk = angular_width(search.diameter.low, search.range.high) * focal;
}

}  // namespace

CameraCheck check_camera(const Camera& camera, const WarpTable& table) {
  CameraCheck check;
  check.model = name_of(camera.config.model);
  check.image = camera.model->image_size();
  check.masked = camera.mask.empty() ? 0 : share_of(camera.mask, false);
  check.panorama = table.panorama();
  check_model(camera, check);
  check_sight(camera, table, check);
  check_resolution(camera, check);
  check.warnings = likely_mistakes(camera, check);
  return check;
}

}  // namespace bole
