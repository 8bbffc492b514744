#include "simulate/impairment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace bole::simulate {
namespace {

// Grey stripes of 4 pixels, so that there is contrast to lose.
Picture stripes(std::uint8_t low, std::uint8_t high) {
  Picture picture{{160, 120}, {}};
  for (int i = 0; i < 160 * 120; ++i)
    picture.rgb.insert(picture.rgb.end(), 3, i % 8 < 4 ? low : high);
  return picture;
}

double mean(const Picture& p) {
  return std::accumulate(p.rgb.begin(), p.rgb.end(), 0.0) / static_cast<double>(p.rgb.size());
}

double contrast(const Picture& p) {
  double sum = 0;
  for (std::size_t i = 0; i + 12 < p.rgb.size(); i += 3) sum += std::abs(p.rgb[i] - p.rgb[i + 12]);
  return sum / static_cast<double>(p.rgb.size() / 3);
}

Picture impaired(Impairment impairment) { return Impairer(impairment, 4).apply(stripes(60, 140)); }

TEST(Impairment, DarknessLeavesNoise) { EXPECT_LT(mean(impaired(Impairment::darkness)), 8); }

TEST(Impairment, GlareBlowsOutAThirdOrMore) {
  const Picture picture = impaired(Impairment::glare);
  EXPECT_GT(std::ranges::count(picture.rgb, 255),
            static_cast<std::ptrdiff_t>(picture.rgb.size() / 3));
}

TEST(Impairment, ACoverTakesTheContrastOfAThird) {
  EXPECT_NEAR(contrast(impaired(Impairment::covered)) / contrast(stripes(60, 140)), 0.67, 0.08);
}

TEST(Impairment, SmearingTakesMostOfTheContrast) {
  EXPECT_LT(contrast(impaired(Impairment::smeared)), 0.4 * contrast(stripes(60, 140)));
}

TEST(Impairment, AFrozenPictureComesAgain) {
  Impairer impairer(Impairment::frozen, 1);
  const Picture first = impairer.apply(stripes(60, 140));
  EXPECT_EQ(impairer.apply(stripes(50, 100)).rgb, first.rgb);
}

TEST(Impairment, NoiseInTheDarkIsNewInEveryPicture) {
  Impairer impairer(Impairment::darkness, 1);
  EXPECT_NE(impairer.apply(stripes(60, 140)).rgb, impairer.apply(stripes(60, 140)).rgb);
}

}  // namespace
}  // namespace bole::simulate
