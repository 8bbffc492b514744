#include "simulate/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace bole::simulate {
namespace {

Column bent_trunk() {
  Column c;
  c.x = 5;
  c.z = -1;
  c.radius = 0.15F;
  c.taper = c.flare = 0;
  c.lean_y = 0.3F;
  c.bow_y = -0.1F;
  c.bent = 2;
  c.height = 10;
  return c;
}

TEST(Column, LeavesTheGroundAsItLeansAndIsStraightAboveItsBend) {
  const Column c = bent_trunk();
  EXPECT_EQ(c.axis_x(3), 5);
  EXPECT_NEAR(c.axis_y(0.01F), 0.003, 1e-4);
  const float slope = c.axis_y(5) - c.axis_y(4);
  EXPECT_NEAR(slope, 0.3 - 2 * 0.1 * 2, 1e-5);
  EXPECT_NEAR(c.axis_y(10) - c.axis_y(9), slope, 1e-5);
}

TEST(Column, IsMetBetweenTheTangentsAboutItsBentAxis) {
  const Column c = bent_trunk();
  for (const float h : {0.3F, 1.0F, 1.7F, 2.5F, 4.0F}) {
    const float range = std::hypot(c.axis_x(h), c.axis_y(h));
    const float tangent = (h + c.z) / (range - c.radius);
    float first = 1, last = -1;
    for (float bearing = -0.2F; bearing < 0.2F; bearing += 2e-4F) {
      if (!meet(c, Ray{std::cos(bearing), std::sin(bearing), tangent})) continue;
      first = std::min(first, bearing);
      last = std::max(last, bearing);
    }
    EXPECT_NEAR(0.5F * (first + last), std::atan2(c.axis_y(h), c.axis_x(h)), 3e-3) << h;
    EXPECT_NEAR(last - first, 2 * std::asin(c.radius / range), 1.5e-3) << h;
  }
}

TEST(Column, ItsHullHoldsItsAxis) {
  Random random(7);
  for (int k = 0; k < 100; ++k) {
    Column c = bent_trunk();
    for (float* side : {&c.lean_x, &c.lean_y, &c.bow_x, &c.bow_y}) *side = 0.2F * random.normal();
    c.bent = random.uniform(0.5F, 12);
    const auto hull = c.axis_hull();
    // Held in every direction: no place of the axis lies farther out than the farthest corner.
    for (float turn = 0; turn < 6.28F; turn += 0.3F) {
      const auto out = [&](float x, float y) { return x * std::cos(turn) + y * std::sin(turn); };
      const Point& farthest = *std::ranges::max_element(
          hull, {}, [&](const Point& corner) { return out(corner.x, corner.y); });
      for (float h = 0; h <= c.height; h += 0.5F)
        EXPECT_LE(out(c.axis_x(h), c.axis_y(h)), out(farthest.x, farthest.y) + 1e-4F);
    }
  }
}

}  // namespace
}  // namespace bole::simulate
