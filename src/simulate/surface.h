#pragma once

#include "simulate/light.h"
#include "simulate/shapes.h"

namespace bole::simulate {

/// What surfaces of a world look like: the light that they send to the viewpoint, and how much of
/// what is behind them leaves hide.
class Surfaces {
 public:
  /// `x, y, z`: the viewpoint in the world.
  Surfaces(const World& world, const Sunlight& sunlight, float x, float y, float z)
      : world_(world), look_(world.look), sunlight_(sunlight), x_(x), y_(y), z_(z) {}

  Colour column(const Column& column, int index, const Hit& hit, const Ray& ray) const;
  Colour boulder(const Boulder& boulder, const Hit& hit, const Ray& ray) const;
  Colour log(const Log& log, const Hit& hit, const Ray& ray) const;
  Colour wall(const Wall& wall, const Hit& hit, const Ray& ray) const;
  Colour leaves(const Leaves& leaves, const Hit& hit, const Ray& ray) const;
  Colour ground(float way, const Ray& ray) const;
  /// Beyond all that is near: far woods and sky.
  Colour backdrop(const Ray& ray) const;

  /// The share of the ray that leaves stop, [0, 1].
  static float opacity(const Leaves& leaves, const Hit& hit, const Ray& ray);

 private:
  struct Place {
    float x, y, z;    // in the world
    float footprint;  // metres that a pixel spans there
  };
  Place place(float way, const Ray& ray) const;
  Colour lit(Colour reflectance, const Hit& hit, const Place& at, int self) const;
  Colour through_air(Colour colour, float way, const Ray& ray) const;
  Colour sky(const Ray& ray, float height) const;
  float stems(float bearing, const Ray& ray, Colour& colour) const;

  const World& world_;
  const Look& look_;
  const Sunlight& sunlight_;
  float x_, y_, z_;
};

}  // namespace bole::simulate
