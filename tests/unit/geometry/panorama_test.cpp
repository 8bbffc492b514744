#include "geometry/panorama.h"

#include <gtest/gtest.h>

#include "geometry/angles.h"

namespace bole {
namespace {

TEST(Panorama, ExampleOfTheDesignHas385Rows) {
  EXPECT_EQ(full_panorama(1440, radians(27), 0.9, 1.05).rows, 385);
}

TEST(Panorama, FirstColumnLooksBackLeftAndBearingsFallToTheRight) {
  const PanoramaGeometry panorama = full_panorama(1440, radians(27), 0.9, 1.05);
  EXPECT_NEAR(panorama.bearing_of_column(0), kPi - kPi / 1440, 1e-12);
  EXPECT_NEAR(panorama.bearing_of_column(719.5), 0, 1e-12);
  EXPECT_NEAR(panorama.bearing_of_column(1079.5), -kPi / 2, 1e-12);
}

TEST(Panorama, ColumnAndRowInvertBearingAndTangent) {
  PanoramaGeometry panorama = full_panorama(1440, radians(27), 0.9, 1.05);
  panorama.first_column = 1400;
  panorama.width = 200;
  for (double column = -0.4; column < 199; column += 7.3) {
    EXPECT_NEAR(panorama.column_of_bearing(panorama.bearing_of_column(column)), column, 1e-9);
  }
  EXPECT_NEAR(panorama.row_of_tangent(panorama.tangent_of_row(12.25)), 12.25, 1e-9);
  EXPECT_NEAR(panorama.tangent_of_row(-0.5), std::tan(radians(27)), 1e-12);
}

}  // namespace
}  // namespace bole
