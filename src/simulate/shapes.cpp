#include "simulate/shapes.h"

#include <algorithm>

namespace bole::simulate {
namespace {

// The flat top of a column that ends below the viewpoint.
std::optional<Hit> meet_top(const Column& c, const Ray& ray) {
  const float top = c.z + c.height;
  if (ray.tangent >= 0 || top >= 0) return std::nullopt;
  const float way = top / ray.tangent;
  const float dx = way * ray.dx - c.axis_x(c.height);
  const float dy = way * ray.dy - c.axis_y(c.height);
  const float r = c.radius_at(c.height);
  if (dx * dx + dy * dy > r * r) return std::nullopt;
  return Hit{way, 0, 0, 1, 0, c.height};
}

}  // namespace

// The circle's centre and radius change slowly with the height, so the height is found by repeated
// substitution.
std::optional<Hit> meet(const Column& c, const Ray& ray) {
  constexpr int kSteps = 3;
  float way = std::max(0.0F, c.x * ray.dx + c.y * ray.dy);
  for (int step = 0;; ++step) {
    const float h = way * ray.tangent - c.z;
    const float at = std::clamp(h, -0.2F, c.height);
    const float x = c.axis_x(at), y = c.axis_y(at), r = c.radius_at(at);
    const float along = x * ray.dx + y * ray.dy, across = x * ray.dy - y * ray.dx;
    // Most columns are passed well beside them; the rest of the search moves the axis by less.
    if (step == 0 && std::abs(across) > 1.6F * r + 0.02F) return std::nullopt;
    const float square = r * r - across * across;
    if (step == kSteps) {
      if (square < 0 || along < 0) return std::nullopt;
      if (h > c.height) return meet_top(c, ray);
      if (h < -0.3F) return std::nullopt;
      return Hit{way, (way * ray.dx - x) / r, (way * ray.dy - y) / r, 0, 0, h};
    }
    way = std::max(0.0F, along - std::sqrt(std::max(0.0F, square)));
  }
}

std::optional<Hit> meet(const Boulder& b, const Ray& ray) {
  // In space stretched so that the boulder is a unit sphere.
  const float p = 1 / b.radius, q = 1 / b.half_height;
  const float dx = ray.dx * p, dy = ray.dy * p, dz = ray.tangent * q;
  const float cx = b.x * p, cy = b.y * p, cz = b.z * q;
  const float a = dx * dx + dy * dy + dz * dz;
  const float half = dx * cx + dy * cy + dz * cz;
  const float square = half * half - a * (cx * cx + cy * cy + cz * cz - 1);
  if (square < 0 || half < 0) return std::nullopt;
  const float way = (half - std::sqrt(square)) / a;
  if (way <= 0) return std::nullopt;
  const float nx = (way * dx - cx) * p, ny = (way * dy - cy) * p, nz = (way * dz - cz) * q;
  const float n = 1 / std::sqrt(nx * nx + ny * ny + nz * nz);
  return Hit{way, nx * n, ny * n, nz * n, 0, 0};
}

std::optional<Hit> meet(const Log& l, const Ray& ray) {
  const float lx = l.bx - l.ax, ly = l.by - l.ay, lz = l.bz - l.az;
  const float length = std::sqrt(lx * lx + ly * ly + lz * lz);
  const float ux = lx / length, uy = ly / length, uz = lz / length;
  const float along_ray = ray.dx * ux + ray.dy * uy + ray.tangent * uz;
  const float along_end = l.ax * ux + l.ay * uy + l.az * uz;
  // What of the ray and of the log's end is across the log.
  const float dx = ray.dx - along_ray * ux, dy = ray.dy - along_ray * uy;
  const float dz = ray.tangent - along_ray * uz;
  const float cx = l.ax - along_end * ux, cy = l.ay - along_end * uy, cz = l.az - along_end * uz;
  const float a = dx * dx + dy * dy + dz * dz, half = dx * cx + dy * cy + dz * cz;
  const float square = half * half - a * (cx * cx + cy * cy + cz * cz - l.radius * l.radius);
  if (square < 0 || a < 1e-9F) return std::nullopt;
  const float way = (half - std::sqrt(square)) / a;
  const float along = way * along_ray - along_end;
  if (way <= 0 || along < 0 || along > length) return std::nullopt;
  const float k = 1 / l.radius;
  return Hit{way, (way * dx - cx) * k, (way * dy - cy) * k, (way * dz - cz) * k, along, 0};
}

std::optional<Hit> meet(const Wall& w, const Ray& ray) {
  const float lx = w.bx - w.ax, ly = w.by - w.ay;
  const float determinant = ray.dx * ly - ray.dy * lx;
  if (std::abs(determinant) < 1e-6F) return std::nullopt;
  const float way = (w.ax * ly - w.ay * lx) / determinant;
  const float share = (w.ax * ray.dy - w.ay * ray.dx) / determinant;
  const float up = way * ray.tangent - w.z;
  if (way <= 0 || share < 0 || share > 1 || up < 0) return std::nullopt;
  const float length = std::sqrt(lx * lx + ly * ly);
  const float along = share * length;
  // The upper edge is as uneven as the thing is: leaves, stones, rock.
  const float rough = w.kind == Wall::Kind::masonry ? 0.01F
                      : w.kind == Wall::Kind::hedge ? 0.12F
                                                    : 0.35F;
  const float top = w.height * (1 + rough * noise(along * 0.9F, w.seed)) +
                    0.5F * rough * noise(along * 7, w.seed + 1);
  if (up > top) return std::nullopt;
  const float side = ly * ray.dx - lx * ray.dy > 0 ? -1.0F : 1.0F;
  return Hit{way, side * ly / length, -side * lx / length, 0, along, up};
}

std::optional<Hit> meet(const Leaves& l, const Ray& ray) {
  const float square = l.x * l.x + l.y * l.y;
  const float ahead = l.x * ray.dx + l.y * ray.dy;
  if (ahead <= 0) return std::nullopt;
  const float way = square / ahead;
  const float u = (l.y * ray.dx - l.x * ray.dy) * way / (std::sqrt(square) * l.half_width);
  const float v = (way * ray.tangent - l.z) / l.height;
  if (u < -1 || u > 1 || v < (l.blades ? 0.0F : -1.0F) || v > 1) return std::nullopt;
  return Hit{way, 0, 0, 1, u, v};
}

}  // namespace bole::simulate
