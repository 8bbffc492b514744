#include "detect/contrast/veil.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "painted_panorama.h"

namespace bole {
namespace {

PaintedPanorama wood() {
  PaintedPanorama panorama(full_panorama(1440, radians(27), 0.9, 1.0));
  panorama.plant({0.5, 2.0, 0.4, 30});
  return panorama;
}

TEST(Veil, IsNoneWhereSomethingIsDark) {
  const PaintedPanorama panorama = wood();
  EXPECT_EQ(veil_over(panorama.view(), panorama.seen()), 0);
}

TEST(Veil, IsAboutWhatIsAddedToEveryPixel) {
  PaintedPanorama panorama = wood();
  panorama.draw_veil(0.35, 130);
  EXPECT_NEAR(veil_over(panorama.view(), panorama.seen()), 4 * 130, 4 * 12);
}

TEST(Veil, IsNotTakenFromWhatIsMasked) {
  PaintedPanorama panorama = wood();
  panorama.draw_veil(0.35, 130);
  const int veil = veil_over(panorama.view(), panorama.seen());
  // The robot's own deck, black, in the lowest rows.
  const std::size_t masked = panorama.pixels().size() / 8;
  std::fill(panorama.pixels().end() - masked, panorama.pixels().end(), std::uint8_t{0});
  EXPECT_EQ(veil_over(panorama.view(), panorama.seen()), 0);
  panorama.mask_last(masked);
  EXPECT_NEAR(veil_over(panorama.view(), panorama.seen()), veil, 4 * 3);
}

TEST(Veil, LeavesSomethingOfAWhitePictureAndNeedsNoPixel) {
  PaintedPanorama panorama = wood();
  std::fill(panorama.pixels().begin(), panorama.pixels().end(), std::uint8_t{255});
  EXPECT_EQ(veil_over(panorama.view(), panorama.seen()), 4 * (255 - 8));
  panorama.mask_last(panorama.pixels().size());
  EXPECT_LE(veil_over(panorama.view(), panorama.seen()), kThickestVeil);
}

}  // namespace
}  // namespace bole
