#include "simulate/fake_wood.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace bole::simulate {
namespace {

constexpr double kCell = 4;  // metres; at most one tree in each
constexpr double kShareOfCells = 0.7;
constexpr double kRadius = 40;  // metres, of the robot's circle
constexpr double kSpeed = 1;    // metres a second
constexpr double kNearest = 1, kFarthest = 8;
constexpr double kHeight = 1.05;  // metres, of the camera
constexpr int kReach = 3;         // cells

// One tree a cell, from the cell's place alone: the wood needs no memory and has no end.
std::mt19937_64 random_of(std::uint64_t seed, int column, int row, std::uint64_t purpose) {
  std::seed_seq mix{seed, static_cast<std::uint64_t>(column + (1 << 20)),
                    static_cast<std::uint64_t>(row + (1 << 20)), purpose};
  return std::mt19937_64(mix);
}

double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

// Of unit standard deviation, near enough to normal.
double deviate(std::mt19937_64& random) {
  double sum = -6;
  for (int k = 0; k < 12; ++k) sum += uniform(random);
  return sum;
}

}  // namespace

const std::vector<Tree>& FakeWood::trees(double seconds) {
  const double heading = seconds * kSpeed / kRadius;
  const double x = kRadius * std::sin(heading), y = kRadius * (1 - std::cos(heading));
  const int column0 = static_cast<int>(std::floor(x / kCell));
  const int row0 = static_cast<int>(std::floor(y / kCell));
  const auto instant = static_cast<std::uint64_t>(std::llround(seconds * 1e6));
  trees_.clear();
  for (int row = row0 - kReach; row <= row0 + kReach; ++row) {
    for (int column = column0 - kReach; column <= column0 + kReach; ++column) {
      std::mt19937_64 random = random_of(seed_, column, row, 0);
      if (uniform(random) > kShareOfCells) continue;
      const double east = (column + uniform(random)) * kCell - x;
      const double north = (row + uniform(random)) * kCell - y;
      const double diameter = 0.2 + 0.4 * uniform(random);
      const double range = std::hypot(east, north);
      if (range < kNearest || range > kFarthest) continue;

      std::mt19937_64 noise = random_of(seed_, column, row, instant + 1);
      Tree tree;
      tree.id = static_cast<std::int32_t>(((column & 0x7FFF) << 16) | (row & 0xFFFF));
      tree.bearing_sigma = 0.004F;
      tree.range_sigma = static_cast<float>(0.01 + 0.01 * range);
      tree.diameter_sigma = 0.015F;
      const double bearing = std::remainder(
          std::atan2(north, east) - heading + deviate(noise) * tree.bearing_sigma, 2 * M_PI);
      const double seen_range = range + deviate(noise) * tree.range_sigma;
      const double seen_diameter = std::max(diameter + deviate(noise) * tree.diameter_sigma, 0.05);
      tree.bearing = static_cast<float>(bearing);
      tree.range = static_cast<float>(seen_range);
      tree.diameter = static_cast<float>(seen_diameter);
      tree.score = static_cast<float>(0.9 + 0.09 * uniform(noise));
      tree.base_elevation =
          static_cast<float>(std::atan2(-kHeight, seen_range - seen_diameter / 2));
      tree.angular_width = static_cast<float>(2 * std::asin(seen_diameter / (2 * seen_range)));
      trees_.push_back(tree);
    }
  }
  return trees_;
}

}  // namespace bole::simulate
