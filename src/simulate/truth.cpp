#include <algorithm>
#include <cmath>

#include "geometry/angles.h"
#include "simulate/simulator.h"

namespace bole::simulate {
namespace {

// Whether the camera's image holds the direction (world axes, any length).
class ImageTest {
 public:
  ImageTest(const Camera& camera, const Pose& pose)
      : camera_(camera),
        camera_from_world_(transposed(rotation_z(pose.heading) * rotation_y(pose.pitch) *
                                      rotation_x(pose.roll) * camera.robot_from_camera)) {}

  bool holds(const Ray& ray) const {
    const auto pixel =
        camera_.model->pixel_from_ray(camera_from_world_ * Vec3{ray.dx, ray.dy, ray.tangent});
    if (!pixel) return false;
    const ImageSize size = camera_.model->image_size();
    const double row = std::round(pixel->row), column = std::round(pixel->column);
    if (row < 0 || column < 0 || row >= size.height || column >= size.width) return false;
    return camera_.mask.empty() || camera_.mask[static_cast<std::size_t>(row) * size.width +
                                                static_cast<std::size_t>(column)] != 0;
  }

 private:
  const Camera& camera_;
  Mat3 camera_from_world_;
};

struct Share {
  float shown = 0, imaged = 0, all = 0;
  double value() const { return imaged < 0.25F * all || imaged == 0 ? 0 : shown / imaged; }
};

constexpr int kAcross = 6, kUp = 20;

// One height of the silhouette, from edge to edge.
void sample_row(const View& view, int column, float h, const ImageTest& image, Share& share) {
  const Column& c = view.column(column);
  const float x = c.axis_x(h), y = c.axis_y(h), range = std::hypot(x, y);
  const float r = c.radius_at(h);
  if (range <= r) return;
  const float bearing = std::atan2(y, x), half = std::asin(r / range);
  for (int i = 0; i < kAcross; ++i) {
    const float b = bearing + half * (2 * (static_cast<float>(i) + 0.5F) / kAcross - 1);
    const float near = range * std::cos(b - bearing) -
                       std::sqrt(std::max(0.0F, r * r - range * range * std::sin(b - bearing) *
                                                            std::sin(b - bearing)));
    const Ray ray{std::cos(b), std::sin(b), (c.z + h) / near, 0.002F};
    share.all += 1;
    if (!image.holds(ray)) continue;
    share.imaged += 1;
    share.shown += view.openness(ray, near, column);
  }
}

}  // namespace

TreeTruth measure_tree(const View& view, int column, const Pose& pose, double ground_z,
                       const Camera& camera) {
  const Column& c = view.column(column);
  TreeTruth t;
  const double range = std::hypot(c.x, c.y);
  const double bearing = wrap_angle(std::atan2(c.y, c.x) - pose.heading);
  t.id = c.tree;
  t.range = range;
  t.bearing = bearing;
  t.x = range * std::cos(bearing);
  t.y = range * std::sin(bearing);
  t.z = ground_z;
  t.diameter = 2.0 * c.radius_at(0.5F);
  t.angular_width = 2 * std::asin(std::min(1.0, t.diameter / (2 * range)));
  const double near = std::max(0.05, range - c.radius_at(0));
  t.base_elevation = std::atan2(c.z, near);
  const double cosine = std::cos(pose.heading), sine = std::sin(pose.heading);
  const double lean_x = c.axis_x(1) - c.x, lean_y = c.axis_y(1) - c.y;
  t.lean_x = cosine * lean_x + sine * lean_y;
  t.lean_y = cosine * lean_y - sine * lean_x;
  t.bright = c.bright;

  const ImageTest image(camera, pose);
  const double low = std::tan(t.base_elevation);
  const double high = std::tan(std::max(radians(25), t.base_elevation + radians(10)));
  Share whole, foot;
  for (int k = 0; k < kUp; ++k) {
    const double tangent = low + (high - low) * (k + 0.5) / kUp;
    const auto h = static_cast<float>(tangent * near - c.z);
    if (h < c.height) sample_row(view, column, h, image, whole);
  }
  for (int k = 0; k < 4; ++k) {
    sample_row(view, column, 0.3F * (static_cast<float>(k) + 0.5F) / 4, image, foot);
  }
  t.visible = whole.value();
  t.foot_visible = foot.value();
  return t;
}

}  // namespace bole::simulate
