#include <algorithm>
#include <array>
#include <cmath>

#include "simulate/world.h"

namespace bole::simulate {
namespace {

constexpr float kStep = 0.5F;  // metres between the knots
constexpr int kWaves = 6;
constexpr float kTurn = 6.2831853F;

struct Wave {
  float x, y, phase, height;
};

std::array<Wave, kWaves> draw_waves(float undulation, std::uint32_t seed) {
  Random random(seed, 1);
  std::array<Wave, kWaves> waves{};
  for (int i = 0; i < kWaves; ++i) {
    const float length = 4.0F * std::pow(1.6F, static_cast<float>(i)) * random.uniform(0.8F, 1.2F);
    const float along = random.uniform(0, kTurn);
    // Longer waves are higher; the sum of the variances is undulation^2.
    const float share = std::sqrt((static_cast<float>(i) + 1) / (kWaves * (kWaves + 1) / 2.0F));
    waves.at(i) = {kTurn / length * std::cos(along), kTurn / length * std::sin(along),
                   random.uniform(0, kTurn), undulation * share * std::sqrt(2.0F)};
  }
  return waves;
}

}  // namespace

Terrain::Terrain(float x0, float y0, float x1, float y1, float slope, float uphill,
                 float undulation, std::uint32_t seed)
    : x0_(x0),
      y0_(y0),
      columns_(static_cast<int>((x1 - x0) / kStep) + 2),
      rows_(static_cast<int>((y1 - y0) / kStep) + 2) {
  const auto waves = draw_waves(undulation, seed);
  const float slope_x = slope * std::cos(uphill), slope_y = slope * std::sin(uphill);
  heights_.reserve(static_cast<std::size_t>(columns_) * rows_);
  for (int j = 0; j < rows_; ++j) {
    for (int i = 0; i < columns_; ++i) {
      const float x = x0 + kStep * static_cast<float>(i), y = y0 + kStep * static_cast<float>(j);
      float height = slope_x * x + slope_y * y;
      for (const Wave& w : waves) height += w.height * std::sin(w.x * x + w.y * y + w.phase);
      heights_.push_back(height);
    }
  }
}

float Terrain::height(float x, float y) const {
  if (heights_.empty()) return 0;
  const float u = std::clamp((x - x0_) / kStep, 0.0F, static_cast<float>(columns_) - 1.001F);
  const float v = std::clamp((y - y0_) / kStep, 0.0F, static_cast<float>(rows_) - 1.001F);
  const int i = static_cast<int>(u), j = static_cast<int>(v);
  const float* knot = heights_.data() + static_cast<std::ptrdiff_t>(j) * columns_ + i;
  const float s = u - static_cast<float>(i), t = v - static_cast<float>(j);
  return mix(mix(knot[0], knot[1], s), mix(knot[columns_], knot[columns_ + 1], s), t);
}

}  // namespace bole::simulate
