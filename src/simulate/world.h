#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "simulate/noise.h"
#include "simulate/options.h"

namespace bole::simulate {

/// Linear light or reflectance.
struct Colour {
  float r = 0, g = 0, b = 0;
};
inline Colour operator*(Colour c, float k) { return {c.r * k, c.g * k, c.b * k}; }
inline Colour operator*(Colour a, Colour b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
inline Colour operator+(Colour a, Colour b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
inline Colour mix(Colour a, Colour b, float t) { return a * (1 - t) + b * t; }

/// On the ground, metres.
struct Point {
  float x = 0, y = 0;
};

/// How the robot stands in the world: metres and radians; roll and pitch are what it rocks beyond
/// what its camera.toml knows.
struct Pose {
  double x = 0, y = 0, heading = 0;
  double roll = 0, pitch = 0;
};

/// The height of the ground over the world's plane: a grid, bilinear between its knots.
class Terrain {
 public:
  Terrain() = default;
  /// Covers [x0, x1] x [y0, y1]; `slope` rises towards bearing `uphill`.
  Terrain(float x0, float y0, float x1, float y1, float slope, float uphill, float undulation,
          std::uint32_t seed);
  float height(float x, float y) const;

 private:
  float x0_ = 0, y0_ = 0;
  int columns_ = 0, rows_ = 0;
  std::vector<float> heights_;
};

/// What a standing round surface looks like.
struct Bark {
  Colour dark, light;  ///< of furrows and ridges
  float scale = 20;    ///< furrows a metre around the trunk
  float stretch = 5;   ///< how much longer than wide they are
  float contrast = 1;  ///< 0: smooth
  float moss = 0;      ///< share covered near the ground
  bool birch = false;  ///< dark cross-bars
};

/// A tapered round column, leaning and bent in its lower part: a tree's trunk, or a post, a stump,
/// a leg. Radius at height h above its foot: radius (1 - taper (h - 0.5)) + radius flare / (1 + (h
/// / flare_height)^2)^2.
struct Column {
  float x = 0, y = 0, z = 0;     ///< the axis at the ground
  float radius = 0.15F;          ///< half a metre up, the flare left out
  float taper = 0.01F;           ///< a metre
  float lean_x = 0, lean_y = 0;  ///< shift of the axis a metre up, as it leaves the ground
  float bow_x = 0, bow_y = 0;    ///< half the change of that a metre, up to the height `bent`
  float bent = 1;                ///< straight above
  float height = 20;
  float flare = 0.2F, flare_height = 0.15F;
  float shade = 0.4F;  ///< share of its light that the ground keeps off the foot
  float heap = 0;      ///< metres up to which litter covers the foot
  Bark bark;
  std::uint32_t seed = 0;
  int tree = -1;  ///< its number in the truth; -1: not a tree
  bool bright = false;

  float radius_at(float h) const {
    const float q = h / flare_height;
    const float k = 1 / (1 + q * q);
    return radius * (1 - taper * (h - 0.5F) + flare * k * k);
  }
  /// Where the axis is at height h.
  float axis_x(float h) const { return x + lean_x * h + bow_x * bow(h); }
  float axis_y(float h) const { return y + lean_y * h + bow_y * bow(h); }
  /// Corners of a polygon that holds the axis as seen from above: a parabola lies within the
  /// triangle of its ends' tangents.
  std::array<Point, 4> axis_hull() const;

 private:
  float bow(float h) const {
    const float curved = h < bent ? h : bent;
    return curved * (2 * h - curved);
  }
};

/// Leaves, grass or litter that stand upright and turn towards whoever looks.
struct Leaves {
  float x = 0, y = 0, z = 0;  ///< middle of a bush, or of a tuft's lower edge
  float half_width = 1, height = 1;
  float leaf = 0.05F;  ///< size of a leaf, or width of a blade, metres
  float density = 0.5F;
  Colour colour;
  bool blades = false;  ///< grass: grows upward from the lower edge
  std::uint32_t seed = 0;
};

/// An ellipsoid, round seen from above: a rock, a body, a head.
struct Boulder {
  float x = 0, y = 0, z = 0;  ///< centre
  float radius = 0.5F, half_height = 0.4F;
  Colour colour;
  float roughness = 1;
  std::uint32_t seed = 0;
};

/// A trunk that lies: a cylinder between two points.
struct Log {
  float ax = 0, ay = 0, az = 0, bx = 0, by = 0, bz = 0;
  float radius = 0.2F;
  Bark bark;
  std::uint32_t seed = 0;
};

/// A hedge, a wall or a cliff: an upright sheet over a line on the ground.
struct Wall {
  enum class Kind { hedge, masonry, cliff };
  float ax = 0, ay = 0, bx = 0, by = 0;
  float z = 0;       ///< of its lower edge
  float height = 2;  ///< above z
  Kind kind = Kind::hedge;
  Colour colour;
  std::uint32_t seed = 0;
};

/// Light, air, ground and backdrop.
struct Look {
  float sun_x = 1, sun_y = 0, sun_slope = 1;  ///< horizontal direction to the sun; its tangent
  float sun_strength = 1.5F;                  ///< against the light of the sky
  float canopy = 0.5F;                        ///< share of the sunlight that leaves keep off
  float canopy_scale = 0.5F;                  ///< pools of light a metre
  Colour sky_low, sky_high;
  Colour litter, moss, soil;  ///< of the ground
  float litter_scale = 12, litter_contrast = 0.5F, patches = 0.3F, patch_scale = 0.4F;
  float grass = 0;  ///< share of the ground that blades grow on
  Colour foliage;
  float backdrop_top = 1, backdrop_cover = 0.6F;  ///< tangent where the crowns end; their closeness
  float stems = 0.4F;                             ///< share of the backdrop's bearings with a stem
  float stem_light = 0.3F;
  float interior = 0.6F;  ///< light within the far wood, against that on its crowns
  float veil = 0;         ///< how much of the far stems leaves hide, from -0.5 to 0.5
  Colour haze;
  float fog = 0, glare = 0;
  float stops = 0, contrast = 1, vignetting = 0.3F, blur_px = 0, noise = 2;
  int jpeg_quality = 100;
};

/// One wood, or one open field, that stands still while the robot drives through it.
struct World {
  Terrain terrain;
  Look look;
  std::vector<Column> columns;  ///< the trees first, then what only looks like one
  int trees = 0;
  std::vector<Leaves> leaves;
  std::vector<Boulder> boulders;
  std::vector<Log> logs;
  std::vector<Wall> walls;
  std::uint32_t seed = 0;
};

/// How far from the drive trees are placed, and listed in the truth, metres.
inline constexpr float kReach = 42;

/// Grows a world around a drive and keeps a lane along it clear.
World grow_world(const SimOptions& options, std::uint64_t seed, const std::vector<Pose>& drive);

}  // namespace bole::simulate
