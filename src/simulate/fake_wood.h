#pragma once

#include <cstdint>
#include <vector>

#include "detect/tree.h"

namespace bole::simulate {

/// A robot's drive through an endless wood, as lists alone: no camera, no pictures. For planners
/// that want something to steer by.
class FakeWood {
 public:
  explicit FakeWood(std::uint64_t seed) : seed_(seed) {}

  /// The trees from 1 to 8 m around the robot `seconds` after the start; it drives a circle of 40 m
  /// radius at 1 m/s. Bearing, range and diameter are off by as much as their sigmas say.
  const std::vector<Tree>& trees(double seconds);

 private:
  std::uint64_t seed_;
  std::vector<Tree> trees_;
};

}  // namespace bole::simulate
