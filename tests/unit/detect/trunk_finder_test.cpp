#include "detect/trunk_finder.h"

#include <gtest/gtest.h>

#include "painted_panorama.h"

namespace bole {
namespace {

TEST(TrunkFinder, ReadsNoOutlineThatLeadsOutOfTheBands) {
  PaintedPanorama panorama(full_panorama(1440, 0.4, 0.9, 1.0));
  panorama.plant({0.5, 3.0, 0.4, 45});
  TrunkFinder finder(panorama.setup());
  finder.candidates(panorama.view());
  const TrunkShape inside{.foot = 200, .left = 700, .right = 720};
  TrunkShape above = inside, beside = inside, leaning = inside, inverted = inside;
  above.foot = -73;
  beside.left = -900;
  beside.right = -880;
  leaning.left_slope = leaning.right_slope = 40;
  inverted.right = inverted.left - 1;

  TrunkFeatures::Values features;
  EXPECT_TRUE(finder.read(panorama.view(), inside, {}, features));
  for (const TrunkShape& shape : {above, beside, leaning, inverted})
    EXPECT_FALSE(finder.read(panorama.view(), shape, {}, features));
}

}  // namespace
}  // namespace bole
