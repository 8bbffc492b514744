#include "simulate/picture.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace bole::simulate {
namespace {

using Direction = PixelRays::Direction;

// Eight places in a pixel, in sixteenths, no two in one row or column of eighths; nor are the first
// four in one of quarters.
constexpr std::array<std::array<float, 2>, 8> kPlaces = {
    {{-7, -3}, {-3, 5}, {1, -5}, {5, 3}, {-5, 7}, {-1, -1}, {3, 1}, {7, -7}}};

constexpr double kMiddleGrey = 0.24;  // of linear light

class Drawing {
 public:
  Drawing(const View& view, const Look& look, const PixelRays& rays, const Pose& pose)
      : view_(view), look_(look), rays_(rays), caster_(pose), size_(rays.size()) {
    const auto pixels = static_cast<std::size_t>(size_.width) * size_.height;
    colours_.resize(pixels);
    surfaces_.resize(pixels, -1);
  }

  void trace() {
    for (int row = 0; row < size_.height; ++row) {
      for (int column = 0; column < size_.width; ++column) {
        const Direction& d = rays_.at(row, column);
        if (!d.seen()) continue;
        const Sight sight = view_.trace(caster_.ray(d.x, d.y, d.z, d.span));
        colours_[index(row, column)] = sight.colour;
        surfaces_[index(row, column)] = sight.surface;
      }
    }
  }

  void smooth_edges() {
    for (int row = 0; row < size_.height; ++row) {
      for (int column = 0; column < size_.width; ++column) {
        if (!rays_.at(row, column).seen() || !on_edge(row, column)) continue;
        colours_[index(row, column)] = averaged(row, column);
      }
    }
  }

  // As a camera's automatic exposure: the mean of the picture, highlights clipped, is a middle
  // grey.
  float exposure() const {
    double sum = 0;
    int seen = 0;
    for (std::size_t i = 0; i < colours_.size(); ++i) {
      if (surfaces_[i] < 0) continue;
      sum += std::min(1.0F, colours_[i].g);
      ++seen;
    }
    const double mean = seen > 0 ? sum / seen : 1;
    return static_cast<float>(kMiddleGrey / std::max(mean, 0.02)) * std::exp2(look_.stops);
  }

  void vignette_and_glare() {
    const float gain = exposure();
    const float middle_row = 0.5F * static_cast<float>(size_.height);
    const float middle_column = 0.5F * static_cast<float>(size_.width);
    const float radius = std::min(middle_row, middle_column);
    const float slope = std::sqrt(1 + look_.sun_slope * look_.sun_slope);
    for (int row = 0; row < size_.height; ++row) {
      for (int column = 0; column < size_.width; ++column) {
        Colour& colour = colours_[index(row, column)];
        const Direction& d = rays_.at(row, column);
        if (!d.seen()) {
          colour = {0.004F, 0.004F, 0.004F};
          continue;
        }
        const float u = (static_cast<float>(row) - middle_row) / radius;
        const float v = (static_cast<float>(column) - middle_column) / radius;
        colour = colour * (gain * (1 - look_.vignetting * std::min(1.0F, u * u + v * v)));
        if (look_.glare <= 0) continue;
        const Ray ray = caster_.ray(d.x, d.y, d.z, 0);
        const float towards =
            (ray.dx * look_.sun_x + ray.dy * look_.sun_y + ray.tangent * look_.sun_slope) /
            (slope * std::sqrt(1 + ray.tangent * ray.tangent));
        const float veil =
            look_.glare * (0.2F + 0.8F * std::max(0.0F, towards) * std::max(0.0F, towards));
        colour = colour + Colour{veil, veil, veil};
      }
    }
  }

  // Three-tap passes whose variances add up to the blur's.
  void blur() {
    const float variance = look_.blur_px * look_.blur_px;
    if (variance < 0.02F) return;
    const int passes = static_cast<int>(std::ceil(variance / 0.5F));
    const float side = variance / (2 * static_cast<float>(passes));
    for (int pass = 0; pass < passes; ++pass) {
      blur_rows(side);
      blur_columns(side);
    }
  }

  Picture develop(std::uint32_t seed) const {
    Picture picture{size_, {}};
    picture.rgb.resize(colours_.size() * 3);
    const std::vector<float> curve = tone_curve();
    std::uint8_t* out = picture.rgb.data();
    for (std::uint32_t i = 0; i < colours_.size(); ++i) {
      const std::array<float, 3> light = {colours_[i].r, colours_[i].g, colours_[i].b};
      for (std::uint32_t k = 0; k < 3; ++k) {
        const float place = std::clamp(light[k], 0.0F, 1.0F) * static_cast<float>(curve.size() - 2);
        const auto step = static_cast<std::size_t>(place);
        const float grey = mix(curve[step], curve[step + 1], place - static_cast<float>(step));
        const float noisy = grey + noise_at(grey, hash(i, k, seed));
        *out++ = static_cast<std::uint8_t>(std::clamp(noisy + 0.5F, 0.0F, 255.0F));
      }
    }
    return picture;
  }

  std::vector<int> take_surfaces() { return std::move(surfaces_); }

 private:
  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * size_.width + column;
  }

  // Leaves fade out by themselves.
  bool on_edge(int row, int column) const {
    const int here = surfaces_[index(row, column)];
    const auto differs = [&](int r, int c) {
      const int there = surfaces_[index(r, c)];
      return there != here && there >= 0 && (here != kLeaves || there >= kFirstColumn) &&
             (there != kLeaves || here >= kFirstColumn);
    };
    return (row > 0 && differs(row - 1, column)) || (column > 0 && differs(row, column - 1)) ||
           (row + 1 < size_.height && differs(row + 1, column)) ||
           (column + 1 < size_.width && differs(row, column + 1));
  }

  Colour averaged(int row, int column) const {
    const Direction& d = rays_.at(row, column);
    const Direction right = rays_.step_right(row, column), down = rays_.step_down(row, column);
    // Edges of trunks are measured to a fraction of a pixel; leaves and distant stems are not.
    const std::size_t places =
        beside_near_column(row, column) ? kPlaces.size() : kPlaces.size() / 2;
    Colour sum;
    for (std::size_t i = 0; i < places; ++i) {
      const float u = kPlaces.at(i)[0] / 16, v = kPlaces.at(i)[1] / 16;
      sum = sum +
            view_
                .trace(caster_.ray(d.x + u * right.x + v * down.x, d.y + u * right.y + v * down.y,
                                   d.z + u * right.z + v * down.z, d.span))
                .colour;
    }
    return sum * (1 / static_cast<float>(places));
  }

  bool beside_near_column(int row, int column) const {
    const auto near = [&](int r, int c) {
      r = std::clamp(r, 0, size_.height - 1);
      c = std::clamp(c, 0, size_.width - 1);
      const int surface = surfaces_[index(r, c)];
      if (surface < kFirstColumn) return false;
      const Column& stem = view_.column(surface - kFirstColumn);
      return stem.x * stem.x + stem.y * stem.y < 15 * 15;
    };
    return near(row, column) || near(row - 1, column) || near(row + 1, column) ||
           near(row, column - 1) || near(row, column + 1);
  }

  void blur_rows(float side) {
    for (int row = 0; row < size_.height; ++row) {
      Colour* const line = colours_.data() + index(row, 0);
      Colour before = line[0];
      for (int i = 0; i + 1 < size_.width; ++i) {
        const Colour own = line[i];
        line[i] = own * (1 - 2 * side) + (before + line[i + 1]) * side;
        before = own;
      }
    }
  }

  void blur_columns(float side) {
    std::vector<Colour> above(colours_.begin(), colours_.begin() + size_.width);
    for (int row = 0; row + 1 < size_.height; ++row) {
      Colour* const line = colours_.data() + index(row, 0);
      const Colour* const below = line + size_.width;
      for (int i = 0; i < size_.width; ++i) {
        const Colour own = line[i];
        line[i] = own * (1 - 2 * side) + (above[i] + below[i]) * side;
        above[i] = own;
      }
    }
  }

  // Grey level over light: a camera's gamma, then the picture's contrast.
  std::vector<float> tone_curve() const {
    constexpr int kSteps = 4096;
    std::vector<float> curve;
    for (int i = 0; i <= kSteps + 1; ++i) {
      const float light = std::min(1.0F, static_cast<float>(i) / kSteps);
      curve.push_back(255 * std::pow(light, look_.contrast / 2.2F));
    }
    return curve;
  }

  // Four bytes' sum is nearly normal, with a standard deviation of 147.8.
  float noise_at(float grey, std::uint32_t bits) const {
    const auto sum = static_cast<float>((bits & 255U) + ((bits >> 8) & 255U) +
                                        ((bits >> 16) & 255U) + (bits >> 24));
    return look_.noise * std::sqrt(0.3F + grey * (0.7F / 128)) * (sum - 510) * (1 / 147.8F);
  }

  const View& view_;
  const Look& look_;
  const PixelRays& rays_;
  RayCaster caster_;
  ImageSize size_;
  std::vector<Colour> colours_;
  std::vector<int> surfaces_;
};

}  // namespace

PixelRays::PixelRays(const Camera& camera) : size_(camera.model->image_size()) {
  constexpr float kLooksSomewhere = 1;  // until the spans are known
  directions_.resize(static_cast<std::size_t>(size_.width) * size_.height);
  for (int row = 0; row < size_.height; ++row) {
    for (int column = 0; column < size_.width; ++column) {
      const auto i = static_cast<std::size_t>(row) * size_.width + column;
      if (!camera.mask.empty() && camera.mask[i] == 0) continue;
      const Pixel pixel{static_cast<double>(row), static_cast<double>(column)};
      const Vec3 ray = camera.model->ray_from_pixel(pixel);
      if (!is_ray(ray)) continue;
      if (camera.mask.empty()) {
        const auto back = camera.model->pixel_from_ray(ray);
        if (!back || std::hypot(back->row - pixel.row, back->column - pixel.column) > 0.5) continue;
      }
      const Vec3 d = normalized(camera.robot_from_camera * ray);
      directions_[i] = {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z),
                        kLooksSomewhere};
    }
  }
  for (int row = 0; row < size_.height; ++row) {
    for (int column = 0; column < size_.width; ++column) {
      Direction& d = directions_[static_cast<std::size_t>(row) * size_.width + column];
      if (!d.seen()) continue;
      const Direction a = step_right(row, column), b = step_down(row, column);
      const float across = a.x * a.x + a.y * a.y + a.z * a.z;
      const float along = b.x * b.x + b.y * b.y + b.z * b.z;
      d.span = std::max(1e-4F, std::sqrt(std::sqrt(across * along)));
    }
  }
}

// From whichever neighbour is seen.
PixelRays::Direction PixelRays::step(int row, int column, int down, int right) const {
  const Direction& here = at(row, column);
  for (const int sign : {1, -1}) {
    const int r = row + sign * down, c = column + sign * right;
    if (r < 0 || c < 0 || r >= size_.height || c >= size_.width || !at(r, c).seen()) continue;
    const Direction& there = at(r, c);
    const auto k = static_cast<float>(sign);
    return {k * (there.x - here.x), k * (there.y - here.y), k * (there.z - here.z), 0};
  }
  return {};
}

RayCaster::RayCaster(const Pose& pose)
    : world_from_robot_(rotation_z(pose.heading) * rotation_y(pose.pitch) * rotation_x(pose.roll)) {
}

Ray RayCaster::ray(float x, float y, float z, float pixel) const {
  const auto along = [&](const Vec3& axis) {
    return static_cast<float>(axis.x) * x + static_cast<float>(axis.y) * y +
           static_cast<float>(axis.z) * z;
  };
  const float dx = along(world_from_robot_.rows[0]), dy = along(world_from_robot_.rows[1]);
  const float dz = along(world_from_robot_.rows[2]);
  const float across = std::max(1e-6F, std::sqrt(dx * dx + dy * dy));
  // Around the nadir a pixel spans more of the bearing, but never less of the ground.
  return {dx / across, dy / across, dz / across,
          pixel * std::sqrt(1 + (dz / across) * (dz / across))};
}

Picture draw(const View& view, const Look& look, const PixelRays& rays, const Pose& pose,
             std::uint32_t noise_seed, std::vector<int>* surfaces) {
  Drawing drawing(view, look, rays, pose);
  drawing.trace();
  drawing.smooth_edges();
  drawing.vignette_and_glare();
  drawing.blur();
  Picture picture = drawing.develop(noise_seed);
  if (surfaces != nullptr) *surfaces = drawing.take_surfaces();
  return picture;
}

}  // namespace bole::simulate
