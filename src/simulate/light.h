#pragma once

#include <vector>

#include "simulate/world.h"

namespace bole::simulate {

/// What of the sun's light reaches a place of the world: shadows of columns, pools of light under
/// the crowns.
class Sunlight {
 public:
  explicit Sunlight(const World& world);
  /// 0 in full shadow, 1 in the sun, at a place of the world. `self`: the column that the place is
  /// on, -1 for none.
  float at(float x, float y, float z, int self) const;

 private:
  const World& world_;
  float low_ = 0;
  std::vector<std::vector<int>> strips_;  // columns by their place across the light
};

}  // namespace bole::simulate
