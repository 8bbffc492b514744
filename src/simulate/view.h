#pragma once

#include <array>
#include <vector>

#include "simulate/surface.h"

namespace bole::simulate {

/// What a ray sees: its light, and a number for the surface that stops most of it. Neighbouring
/// pixels with unlike numbers have an edge between them.
struct Sight {
  Colour colour;
  int surface = 0;
};

inline constexpr int kBackdrop = 0;
inline constexpr int kGround = 1;
inline constexpr int kLeaves = 2;
inline constexpr int kFirstColumn = 16;  ///< surface of columns[i] is kFirstColumn + i

/// A world seen from one viewpoint. Everything is sorted by bearing, then by distance, so that a
/// ray meets few things.
class View {
 public:
  /// `x, y, z`: the viewpoint.
  View(const World& world, const Sunlight& sunlight, float x, float y, float z);

  Sight trace(const Ray& ray) const;

  /// The column as the viewpoint sees it: its coordinates are relative to the viewpoint.
  const Column& column(int i) const { return columns_[i]; }
  /// Where the ray meets columns[i], whether hidden or not.
  std::optional<Hit> meet_column(int i, const Ray& ray) const { return meet(columns_[i], ray); }
  /// The share of light that comes through to the viewpoint from `way` metres along the ray, the
  /// column `target` itself left out.
  float openness(const Ray& ray, float way, int target) const;

 private:
  enum class Kind : std::uint8_t { column, boulder, log, wall, leaves };
  struct Item {
    float near = 0;           // metres of horizontal way at which it may first be met
    float low = 0, high = 0;  // tangents between which it lies
    int index = 0;
    Kind kind = Kind::column;
  };
  static constexpr int kSectors = 1024;
  static constexpr int kRings = 72;

  void add_items();
  void add(const Item& item, float x, float y, float reach);
  void add_wall(int index);
  void survey_ground(const Terrain& terrain, float x, float y, float z);
  float ground_way(const Ray& ray) const;
  std::optional<Hit> meet_item(const Item& item, const Ray& ray) const;
  Colour colour_of(const Item& item, const Hit& hit, const Ray& ray) const;

  const World& world_;
  Surfaces surfaces_;
  float x_, y_, z_;
  std::vector<Column> columns_;
  std::vector<Boulder> boulders_;
  std::vector<Log> logs_;
  std::vector<Wall> walls_;
  std::vector<Leaves> leaves_;
  std::vector<std::vector<Item>> sectors_;
  std::array<float, kRings> rings_{};               // horizontal ways
  std::vector<std::array<float, kRings>> highest_;  // tangent of the ground seen so far
};

}  // namespace bole::simulate
