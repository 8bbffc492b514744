#pragma once

#include <cmath>
#include <optional>

#include "simulate/world.h"

namespace bole::simulate {

/// A line of sight from the viewpoint, which is the origin here: after s metres of horizontal way
/// it is at (s dx, s dy, s tangent).
struct Ray {
  float dx = 1, dy = 0;  ///< unit, horizontal
  float tangent = 0;     ///< of the elevation
  float pixel = 0.004F;  ///< radians that a pixel spans
};

/// Where a ray meets a surface: horizontal way, outward normal, and two coordinates on the surface.
struct Hit {
  float way = 0;
  float nx = 0, ny = 0, nz = 0;
  float u = 0, v = 0;  ///< see each shape
};

/// Shapes whose coordinates are relative to the viewpoint. Each gives the nearest hit, or nothing.

/// u: unused; v: height above the foot. The normal is that of the circle at that height, (0, 0, 1)
/// on the cut top of a stump.
std::optional<Hit> meet(const Column& column, const Ray& ray);
std::optional<Hit> meet(const Boulder& boulder, const Ray& ray);
/// u: metres along the log.
std::optional<Hit> meet(const Log& log, const Ray& ray);
/// u: metres along the wall, v: above its lower edge.
std::optional<Hit> meet(const Wall& wall, const Ray& ray);

/// Where the ray passes the upright sheet that the leaves stand in, which faces the viewpoint. u,
/// v: from -1 to 1 across and up (bush), or v from 0 at the lower edge to 1 (blades).
std::optional<Hit> meet(const Leaves& leaves, const Ray& ray);

}  // namespace bole::simulate
