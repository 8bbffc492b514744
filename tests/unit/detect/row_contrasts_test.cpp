#include "detect/network/row_contrasts.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "simulate/noise.h"

namespace bole {
namespace {

using F = TrunkFeatures;

struct Cells {
  std::array<float, std::size_t{F::kHeights} * F::kAcross> grid{};
  std::array<float, std::size_t{F::kFootRows} * F::kStrips> foot{};
  std::array<float, F::kRowContrasts> numbers{};

  void even(float unit = 1) {
    even_rows(row_contrasts(unit, grid.data(), numbers.data()), grid.data());
    even_foot(unit, foot.data());
  }
  float* row(int h) { return grid.data() + h * F::kAcross; }
  float number(int which, int h) const { return numbers[which * F::kHeights + h]; }
};

Cells random_cells() {
  simulate::Random random(11);
  Cells cells;
  for (float& value : cells.grid) value = random.normal();
  for (float& value : cells.foot) value = random.normal();
  return cells;
}

// A dark trunk that fills the middle four cells of a row.
void draw_trunk(float* row, float brightness, float contrast) {
  for (int i = 0; i < F::kAcross; ++i) row[i] = brightness - (i >= 4 && i < 8 ? contrast : 0);
}

TEST(RowContrasts, AFaintRowComesOutAsStrongAsAStarkOne) {
  Cells cells = random_cells();
  draw_trunk(cells.row(2), 0, 0.2F);
  draw_trunk(cells.row(9), 3, 2);
  cells.even();
  for (int i = 0; i < F::kAcross; ++i) EXPECT_NEAR(cells.row(2)[i], cells.row(9)[i], 1e-4);
  EXPECT_NEAR(cells.number(1, 9) - cells.number(1, 2), std::log(10), 1e-4);
}

TEST(RowContrasts, WhatIsHardlyThereIsNotBlownUp) {
  Cells cells = random_cells();
  draw_trunk(cells.row(4), 1, 0.001F);
  cells.even();
  for (int i = 0; i < F::kAcross; ++i) EXPECT_LT(std::abs(cells.row(4)[i]), 0.03F);
}

TEST(RowContrasts, TheUnitOfTheInputsDoesNotMatterToTheRows) {
  Cells one = random_cells(), half = one;
  for (float& value : half.grid) value *= 2;
  for (float& value : half.foot) value *= 2;
  one.even(1);
  half.even(0.5F);
  for (std::size_t i = 0; i < one.grid.size(); ++i) EXPECT_NEAR(one.grid[i], half.grid[i], 1e-4);
  for (std::size_t i = 0; i < one.foot.size(); ++i) EXPECT_NEAR(one.foot[i], half.foot[i], 1e-4);
}

TEST(RowContrasts, TellsATrunkFromAStepByTheProductOfItsEdges) {
  Cells cells = random_cells();
  draw_trunk(cells.row(3), 0, 1);
  for (int i = 0; i < F::kAcross; ++i) cells.row(5)[i] = i < 6 ? 0.0F : 1.0F;
  for (int i = 0; i < F::kAcross; ++i) cells.row(6)[i] = 0.25F * static_cast<float>(i);
  cells.even();
  EXPECT_GT(cells.number(5, 3), 1);
  EXPECT_EQ(cells.number(5, 5), 0);
  EXPECT_LT(cells.number(5, 6), -0.5F);
  EXPECT_NEAR(cells.number(2, 3), cells.number(3, 3), 1e-5);
  EXPECT_NEAR(cells.number(4, 3), cells.number(2, 3), 1e-5);
}

}  // namespace
}  // namespace bole
