#include "simulate/view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace bole::simulate {
namespace {

constexpr float kFirstRing = 0.2F, kRingGrowth = 1.09F;
constexpr float kFar = std::numeric_limits<float>::max();

// A number in [0, 4) that grows with the bearing: 0 ahead, 1 to the left.
float around(float dx, float dy) {
  const float s = dy / (std::abs(dx) + std::abs(dy));
  return dx < 0 ? 2 - s : s < 0 ? 4 + s : s;
}

// Tangents between which something from z_low to z_high, `near` to `far` metres away, is seen.
float lowest_tangent(float z, float near, float far) { return z / (z < 0 ? near : far); }
float highest_tangent(float z, float near, float far) { return z / (z < 0 ? far : near); }

}  // namespace

View::View(const World& world, const Sunlight& sunlight, float x, float y, float z)
    : world_(world), surfaces_(world, sunlight, x, y, z), x_(x), y_(y), z_(z), sectors_(kSectors) {
  add_items();
  for (auto& sector : sectors_) {
    std::ranges::sort(sector, [](const Item& a, const Item& b) {
      return std::tuple(a.near, a.kind, a.index) < std::tuple(b.near, b.kind, b.index);
    });
  }
  survey_ground(world.terrain, x, y, z);
}

void View::add(const Item& item, float x, float y, float reach) {
  const float range = std::hypot(x, y);
  if (range <= reach) {
    for (auto& sector : sectors_) sector.push_back(item);
    return;
  }
  const float bearing = std::atan2(y, x), half = std::asin(reach / range);
  const float step = kSectors / 4.0F;
  const int first =
      static_cast<int>(around(std::cos(bearing - half), std::sin(bearing - half)) * step);
  const int last =
      static_cast<int>(around(std::cos(bearing + half), std::sin(bearing + half)) * step);
  for (int i = first;; ++i) {
    sectors_[i % kSectors].push_back(item);
    if (i % kSectors == last % kSectors) break;
  }
}

void View::add_wall(int index) {
  const Wall& w = walls_[index];
  const float lx = w.bx - w.ax, ly = w.by - w.ay;
  const float share = std::clamp(-(w.ax * lx + w.ay * ly) / (lx * lx + ly * ly), 0.0F, 1.0F);
  const float near = std::max(0.05F, std::hypot(w.ax + share * lx, w.ay + share * ly));
  const float far = std::max(std::hypot(w.ax, w.ay), std::hypot(w.bx, w.by));
  const Item item{near, lowest_tangent(w.z, near, far),
                  highest_tangent(w.z + 1.6F * w.height, near, far), index, Kind::wall};
  const float x = 0.5F * (w.ax + w.bx), y = 0.5F * (w.ay + w.by);
  add(item, x, y, std::min(0.5F * std::hypot(lx, ly), 0.999F * std::hypot(x, y)));
}

void View::add_items() {
  const auto moved = [&](auto list, auto shift) {
    for (auto& thing : list) shift(thing);
    return list;
  };
  const auto centre = [&](auto& t) { t.x -= x_, t.y -= y_, t.z -= z_; };
  columns_ = moved(world_.columns, centre);
  boulders_ = moved(world_.boulders, centre);
  leaves_ = moved(world_.leaves, centre);
  logs_ = moved(world_.logs, [&](Log& l) {
    l.ax -= x_, l.ay -= y_, l.az -= z_, l.bx -= x_, l.by -= y_, l.bz -= z_;
  });
  walls_ = moved(world_.walls,
                 [&](Wall& w) { w.ax -= x_, w.ay -= y_, w.bx -= x_, w.by -= y_, w.z -= z_; });

  for (int i = 0; i < static_cast<int>(columns_.size()); ++i) {
    const Column& c = columns_[i];
    const auto hull = c.axis_hull();
    const auto farthest_from = [&](float x, float y) {
      float way = 0;
      for (const Point& p : hull) way = std::max(way, std::hypot(p.x - x, p.y - y));
      return way + c.radius_at(0);
    };
    const float body = farthest_from(c.x, c.y), range = std::hypot(c.x, c.y);
    const float near = std::max(0.05F, range - body), far = range + body;
    // The lean shifts it to one side only.
    const float x = 0.5F * (c.x + hull.back().x), y = 0.5F * (c.y + hull.back().y);
    add({near, lowest_tangent(c.z - 0.3F, near, far), highest_tangent(c.z + c.height, near, far), i,
         Kind::column},
        x, y, farthest_from(x, y));
  }
  const auto add_round = [&](Kind kind, int i, const auto& t, float reach, float low, float high) {
    const float range = std::hypot(t.x, t.y);
    const float near = std::max(0.05F, range - reach), far = range + reach;
    add({near, lowest_tangent(low, near, far), highest_tangent(high, near, far), i, kind}, t.x, t.y,
        reach);
  };
  for (int i = 0; i < static_cast<int>(boulders_.size()); ++i) {
    const Boulder& b = boulders_[i];
    add_round(Kind::boulder, i, b, b.radius, b.z - b.half_height, b.z + b.half_height);
  }
  for (int i = 0; i < static_cast<int>(leaves_.size()); ++i) {
    const Leaves& l = leaves_[i];
    const float range = std::hypot(l.x, l.y);
    if (range < 0.2F || l.height < 0.002F * range) continue;
    const float half = std::min(l.half_width, 0.95F * range);  // the sheet stands across the view
    const float low = l.blades ? l.z : l.z - l.height, high = l.z + l.height;
    const float far = std::hypot(range, half);
    add({range, lowest_tangent(low, range, far), highest_tangent(high, range, far), i,
         Kind::leaves},
        l.x, l.y, half);
  }
  for (int i = 0; i < static_cast<int>(logs_.size()); ++i) {
    const Log& l = logs_[i];
    const struct { float x, y; } middle{0.5F * (l.ax + l.bx), 0.5F * (l.ay + l.by)};
    add_round(Kind::log, i, middle, 0.5F * std::hypot(l.bx - l.ax, l.by - l.ay) + l.radius,
              std::min(l.az, l.bz) - l.radius, std::max(l.az, l.bz) + l.radius);
  }
  for (int i = 0; i < static_cast<int>(walls_.size()); ++i) add_wall(i);
}

void View::survey_ground(const Terrain& terrain, float x, float y, float z) {
  float way = kFirstRing;
  for (float& ring : rings_) {
    ring = way;
    way *= kRingGrowth;
  }
  highest_.resize(kSectors);
  for (int i = 0; i < kSectors; ++i) {
    const float a = (static_cast<float>(i) + 0.5F) * (4.0F / kSectors);
    // The inverse of around().
    float dx = a < 1 ? 1 - a : a < 3 ? 1 - a : a - 3;
    float dy = a < 1 ? a : a < 3 ? 2 - a : a - 4;
    const float n = 1 / std::sqrt(dx * dx + dy * dy);
    dx *= n;
    dy *= n;
    float highest = -kFar;
    for (int k = 0; k < kRings; ++k) {
      const float ground = terrain.height(x + rings_[k] * dx, y + rings_[k] * dy) - z;
      highest = std::max(highest, ground / rings_[k]);
      highest_[i][k] = highest;
    }
  }
}

// The first place where the ground stands as high as the ray, bracketed by the survey of the ray's
// sector, then by secants on the ground itself.
float View::ground_way(const Ray& ray) const {
  const auto& highest =
      highest_[static_cast<int>(around(ray.dx, ray.dy) * (kSectors / 4.0F)) % kSectors];
  const auto* const found = std::ranges::lower_bound(highest, ray.tangent);
  if (found == highest.end()) return kFar;
  const auto k = found - highest.begin();
  if (k == 0) return ray.tangent < 0 ? std::min(kFirstRing, z_ / -ray.tangent) : kFirstRing;
  const auto over = [&](float way) {
    return way * ray.tangent + z_ - world_.terrain.height(x_ + way * ray.dx, y_ + way * ray.dy);
  };
  float a = rings_[k - 1], b = rings_[k];
  const float low = a * 0.9F, high = b * 1.1F;
  float over_a = over(a), over_b = over(b);
  for (int step = 0; step < 4 && std::abs(over_b) > 1e-5F && over_a != over_b; ++step) {
    const float next = std::clamp(b - over_b * (b - a) / (over_b - over_a), low, high);
    a = b;
    over_a = over_b;
    b = next;
    over_b = over(b);
  }
  return b;
}

std::optional<Hit> View::meet_item(const Item& item, const Ray& ray) const {
  switch (item.kind) {
    case Kind::column:
      return meet(columns_[item.index], ray);
    case Kind::boulder:
      return meet(boulders_[item.index], ray);
    case Kind::log:
      return meet(logs_[item.index], ray);
    case Kind::wall:
      return meet(walls_[item.index], ray);
    case Kind::leaves:
      break;
  }
  return meet(leaves_[item.index], ray);
}

Colour View::colour_of(const Item& item, const Hit& hit, const Ray& ray) const {
  switch (item.kind) {
    case Kind::column:
      return surfaces_.column(columns_[item.index], item.index, hit, ray);
    case Kind::boulder:
      return surfaces_.boulder(boulders_[item.index], hit, ray);
    case Kind::log:
      return surfaces_.log(logs_[item.index], hit, ray);
    case Kind::wall:
      return surfaces_.wall(walls_[item.index], hit, ray);
    case Kind::leaves:
      break;
  }
  return surfaces_.leaves(leaves_[item.index], hit, ray);
}

Sight View::trace(const Ray& ray) const {
  struct Veil {
    const Item* item;
    Hit hit;
    float opacity;
  };
  std::array<Veil, 12> veils;
  std::size_t count = 0;
  float end = ground_way(ray);
  const Item* solid = nullptr;
  Hit solid_hit;
  const auto sector =
      static_cast<std::size_t>(around(ray.dx, ray.dy) * (kSectors / 4.0F)) % kSectors;
  float left = 1;
  for (const Item& item : sectors_[sector]) {
    if (item.near > end || left < 0.02F) break;
    if (ray.tangent < item.low || ray.tangent > item.high) continue;
    const auto hit = meet_item(item, ray);
    if (!hit || hit->way >= end) continue;
    if (item.kind != Kind::leaves) {
      solid = &item;
      solid_hit = *hit;
      end = hit->way;
    } else if (count < veils.size()) {
      const float opacity = Surfaces::opacity(leaves_[item.index], *hit, ray);
      if (opacity < 0.01F) continue;
      veils[count++] = {&item, *hit, opacity};
      left *= 1 - opacity;
    }
  }

  Sight sight{{}, kBackdrop};
  left = 1;
  for (std::size_t i = 0; i < count && veils[i].hit.way < end; ++i) {
    sight.colour =
        sight.colour + colour_of(*veils[i].item, veils[i].hit, ray) * (left * veils[i].opacity);
    left *= 1 - veils[i].opacity;
  }
  if (left > 0.02F) {
    Colour behind;
    if (solid != nullptr) {
      behind = colour_of(*solid, solid_hit, ray);
    } else {
      behind = end < kFar ? surfaces_.ground(end, ray) : surfaces_.backdrop(ray);
    }
    sight.colour = sight.colour + behind * left;
  }
  if (left < 0.5F) {
    sight.surface = kLeaves;
  } else if (solid == nullptr) {
    sight.surface = end < kFar ? kGround : kBackdrop;
  } else {
    sight.surface = solid->kind == Kind::column ? kFirstColumn + solid->index
                                                : kLeaves + static_cast<int>(solid->kind);
  }
  return sight;
}

float View::openness(const Ray& ray, float way, int target) const {
  if (ground_way(ray) < way - 0.02F) return 0;
  const auto sector =
      static_cast<std::size_t>(around(ray.dx, ray.dy) * (kSectors / 4.0F)) % kSectors;
  float left = 1;
  for (const Item& item : sectors_[sector]) {
    if (item.near > way) break;
    if (item.kind == Kind::column && item.index == target) continue;
    if (ray.tangent < item.low || ray.tangent > item.high) continue;
    const auto hit = meet_item(item, ray);
    if (!hit || hit->way >= way) continue;
    if (item.kind != Kind::leaves) return 0;
    left *= 1 - Surfaces::opacity(leaves_[item.index], *hit, ray);
  }
  return left;
}

}  // namespace bole::simulate
