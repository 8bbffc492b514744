#include "simulate/light.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bole::simulate {
namespace {

constexpr float kStrip = 0.5F;  // metres across the light
constexpr float kCrowns = 9;    // metres: where the light is filtered

}  // namespace

Sunlight::Sunlight(const World& world) : world_(world) {
  const Look& look = world.look;
  const auto across = [&](float x, float y) { return y * look.sun_x - x * look.sun_y; };
  float high = 0;
  for (const Column& c : world.columns) {
    low_ = std::min(low_, across(c.x, c.y) - 12);
    high = std::max(high, across(c.x, c.y) + 12);
  }
  strips_.resize(static_cast<std::size_t>((high - low_) / kStrip) + 1);
  const int last = static_cast<int>(strips_.size()) - 1;
  for (int i = 0; i < static_cast<int>(world.columns.size()); ++i) {
    const Column& c = world.columns[i];
    float least = std::numeric_limits<float>::max(), most = std::numeric_limits<float>::lowest();
    for (const Point& p : c.axis_hull()) {
      least = std::min(least, across(p.x, p.y));
      most = std::max(most, across(p.x, p.y));
    }
    const float wide = c.radius * (1 + c.flare) + 0.2F;
    const int a = static_cast<int>((least - wide - low_) / kStrip);
    const int b = static_cast<int>((most + wide - low_) / kStrip);
    for (int k = std::clamp(a, 0, last); k <= std::clamp(b, 0, last); ++k) strips_[k].push_back(i);
  }
}

float Sunlight::at(float x, float y, float z, int self) const {
  const Look& look = world_.look;
  const float reach = (kCrowns - z) / look.sun_slope;
  const float crown_x = (x + look.sun_x * reach) * look.canopy_scale;
  const float crown_y = (y + look.sun_y * reach) * look.canopy_scale;
  const float holes = fractal(crown_x, crown_y, 1, 3, 0.7F, 0, world_.seed + 77);
  const float threshold = look.canopy * 2 - 1;
  float light = smooth_step(threshold - 0.1F, threshold + 0.15F, 1.4F * holes);
  if (light <= 0) return 0;

  const float place = (y * look.sun_x - x * look.sun_y - low_) / kStrip;
  if (place < 0 || place >= static_cast<float>(strips_.size())) return light;
  for (const int i : strips_[static_cast<std::size_t>(place)]) {
    const Column& c = world_.columns[i];
    const float towards = (c.x - x) * look.sun_x + (c.y - y) * look.sun_y;
    const float h = z + towards * look.sun_slope - c.z;
    if (i == self || towards <= 0 || h > c.height) continue;
    const float dx = c.axis_x(h) - x, dy = c.axis_y(h) - y;
    const float beside = std::abs(dy * look.sun_x - dx * look.sun_y);
    const float r = c.radius_at(std::max(h, 0.0F)), penumbra = 0.01F + 0.006F * towards;
    light *= smooth_step(r - penumbra, r + penumbra, beside);
  }
  return light;
}

}  // namespace bole::simulate
