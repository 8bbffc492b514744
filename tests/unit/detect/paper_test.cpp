#include "detect/paper/paper.h"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>

#include "geometry/angles.h"
#include "unit/detect/paper_oracle.h"

namespace bole {
namespace {

constexpr double kHeight = 1.05;

// Dark and bright bars with noise on a ground that darkens towards the robot.
cv::Mat1b bars_and_noise(const PanoramaGeometry& panorama, std::uint64_t seed) {
  cv::RNG rng(seed);
  cv::Mat1b image(panorama.rows, panorama.width);
  for (int i = 0; i < image.rows; ++i) image.row(i).setTo(200 - 100 * i / image.rows);
  for (int k = 0; k < 40; ++k) {
    const int width = rng.uniform(2, 60);
    const cv::Rect bar(rng.uniform(-width, image.cols), 0, width, rng.uniform(100, image.rows));
    image(bar & cv::Rect(0, 0, image.cols, image.rows)).setTo(rng.uniform(0, 256));
  }
  cv::Mat1b noise(image.size());
  rng.fill(noise, cv::RNG::UNIFORM, 0, 40);
  image += noise;
  return image;
}

PanoramaView view_of(const cv::Mat1b& image, const PanoramaGeometry& panorama) {
  return {&panorama, image.data, static_cast<int>(image.step)};
}

void read_in_strips(PaperScores& scores, const cv::Mat1b& image, int strip) {
  scores.rows().begin();
  for (int i = 0; i < image.rows; i += strip) {
    scores.rows().add_rows(image.ptr(i), static_cast<int>(image.step),
                           std::min(strip, image.rows - i));
  }
  scores.rows().end();
}

// The largest difference between the closed form and the oracle over the range of the oracle's
// scores, over all templates and columns.
double error_over_range(const PanoramaGeometry& panorama, double height, const Search& search,
                        const cv::Mat1b& image, int strip = 16) {
  PaperScores fast(panorama, paper_templates(panorama, height, search));
  read_in_strips(fast, image, strip);
  double error = 0, low = 1e9, high = -1e9;
  for (std::size_t k = 0; k < fast.templates().size(); ++k) {
    const cv::Mat1d oracle = literal_paper_scores(image, panorama.wraps(), fast.templates()[k]);
    const std::span<const float> scores = fast.scores(k);
    for (int j = 0; j < panorama.width; ++j) {
      error = std::max(error, std::abs(scores[j] - oracle(j)));
      low = std::min(low, oracle(j));
      high = std::max(high, oracle(j));
    }
  }
  return error / (high - low);
}

TEST(PaperTemplates, AreFiveDiametersAtEachWholeMetre) {
  const PanoramaGeometry panorama = full_panorama(1440, radians(27), 0.9, kHeight);
  const auto templates = paper_templates(panorama, kHeight, {{1, 8}, {0.2, 0.8}});
  ASSERT_EQ(templates.size(), 40);
  EXPECT_EQ(templates[7].foot_distance, 2);
  EXPECT_NEAR(templates[7].diameter, 0.5, 1e-12);
  // d = 2 a sin(w / 2) / (1 - sin(w / 2)) at w = 2 pi s / columns.
  const double half = std::sin(kPi * templates[7].width_px / 1440);
  EXPECT_NEAR(2 * 2 * half / (1 - half), 0.5, 1e-12);
  EXPECT_NEAR(panorama.tangent_of_row(templates[7].foot_row), -kHeight / 2,
              0.51 / panorama.focal());
  EXPECT_EQ(paper_templates(panorama, kHeight, {{1, 40}, {0.1, 1.2}}).size(), 200);
}

TEST(PaperTemplates, OfARangeWithoutAWholeMetreStandAtItsNearEnd) {
  const PanoramaGeometry panorama = full_panorama(1440, radians(27), 0.9, kHeight);
  const auto templates = paper_templates(panorama, kHeight, {{2.2, 2.8}, {0.2, 0.8}});
  ASSERT_EQ(templates.size(), 5);
  EXPECT_EQ(templates[0].foot_distance, 2.2);
}

TEST(PaperTemplates, LeaveOutDepthsBelowThePanorama) {
  const PanoramaGeometry panorama = full_panorama(1440, radians(27), 2.5, kHeight);
  const auto templates = paper_templates(panorama, kHeight, {{1, 8}, {0.2, 0.8}});
  ASSERT_EQ(templates.size(), 30);
  EXPECT_EQ(templates[0].foot_distance, 3);
}

TEST(PaperScores, EqualTheLiteralFilterOnAFullTurn) {
  const PanoramaGeometry panorama = full_panorama(480, radians(27), 0.9, kHeight);
  EXPECT_LT(error_over_range(panorama, kHeight, {}, bars_and_noise(panorama, 1)), 1e-5);
}

TEST(PaperScores, EqualTheLiteralFilterOnPartOfATurn) {
  PanoramaGeometry panorama = full_panorama(480, radians(27), 0.9, kHeight);
  panorama.first_column = 401;
  panorama.width = 131;  // no multiple of any vector
  EXPECT_LT(error_over_range(panorama, kHeight, {}, bars_and_noise(panorama, 2)), 1e-5);
}

TEST(PaperScores, EqualTheLiteralFilterWhereBarsReachOverTopAndBottom) {
  const PanoramaGeometry panorama = full_panorama(480, radians(2), 0.98, kHeight);
  const Search near_and_wide{{1, 3}, {0.1, 3}};
  EXPECT_LT(error_over_range(panorama, kHeight, near_and_wide, bars_and_noise(panorama, 3)), 1e-5);
}

TEST(PaperScores, EqualTheLiteralFilterUpTo40Metres) {
  const PanoramaGeometry panorama = full_panorama(480, radians(27), 0.9, kHeight);
  const Search far{{1, 40}, {0.1, 1.2}};
  EXPECT_LT(error_over_range(panorama, kHeight, far, bars_and_noise(panorama, 4)), 1e-5);
}

TEST(PaperScores, DoNotDependOnHowTheRowsArrive) {
  const PanoramaGeometry panorama = full_panorama(480, radians(27), 0.9, kHeight);
  const cv::Mat1b image = bars_and_noise(panorama, 5);
  PaperScores whole(panorama, paper_templates(panorama, kHeight, {}));
  PaperScores strips = whole;
  read_in_strips(whole, image, image.rows);
  read_in_strips(strips, image, 5);
  for (std::size_t k = 0; k < whole.templates().size(); ++k) {
    EXPECT_THAT(strips.scores(k), testing::ElementsAreArray(whole.scores(k)));
  }
}

// A dark trunk of one of the template's diameters that stands at one of its depths.
cv::Mat1b one_trunk(const PanoramaGeometry& panorama, double bearing, double foot_distance,
                    double angular_width) {
  cv::Mat1b image(panorama.rows, panorama.width, 150);
  const double centre = panorama.column_of_bearing(bearing);
  const double half = angular_width * panorama.focal() / 2;
  const int foot = static_cast<int>(panorama.row_of_tangent(-kHeight / foot_distance));
  for (int x = static_cast<int>(centre - half); x <= centre + half; ++x) {
    image.col((x + panorama.width) % panorama.width).rowRange(0, foot + 1).setTo(20);
  }
  return image;
}

// Every row, in each column.
std::vector<SeenRows> all_seen(const PanoramaGeometry& panorama) {
  return {static_cast<std::size_t>(panorama.width), {0, static_cast<std::uint16_t>(panorama.rows)}};
}

TEST(PaperDetector, FindsATrunkAlsoAcrossTheSeam) {
  const PanoramaGeometry panorama = full_panorama(1440, radians(27), 0.9, kHeight);
  const std::vector<SeenRows> seen = all_seen(panorama);
  PaperDetector detector(
      {.panorama = panorama, .seen = {{}, seen}, .height = kHeight, .search = {}});
  for (const double bearing : {0.7, -kPi + 0.01}) {
    const cv::Mat1b image = one_trunk(panorama, bearing, 3, 0.15);
    const std::span<const Tree> trees = detector.detect(view_of(image, panorama));
    ASSERT_GE(trees.size(), 1);
    EXPECT_NEAR(wrap_angle(trees[0].bearing - bearing), 0, 0.01);
    EXPECT_GT(trees[0].score, 0.5);
    EXPECT_NEAR(trees[0].angular_width, 2 * std::asin(trees[0].diameter / 2 / trees[0].range),
                1e-5);
    EXPECT_NEAR(std::tan(trees[0].base_elevation),
                -kHeight / (trees[0].range - trees[0].diameter / 2), 1e-5);
  }
}

TEST(PaperDetector, FindsNothingInAColumnThatIsNotSeen) {
  const PanoramaGeometry panorama = full_panorama(1440, radians(27), 0.9, kHeight);
  const cv::Mat1b image = one_trunk(panorama, 0.7, 3, 0.15);
  std::vector<SeenRows> seen = all_seen(panorama);
  const int centre = static_cast<int>(panorama.column_of_bearing(0.7));
  for (int x = -60; x <= 60; ++x) seen[centre + x] = {};
  PaperDetector detector(
      {.panorama = panorama, .seen = {{}, seen}, .height = kHeight, .search = {}});
  for (const Tree& tree : detector.detect(view_of(image, panorama))) {
    EXPECT_GT(std::abs(panorama.column_of_bearing(tree.bearing) - centre), 60);
  }
}

TEST(PaperDetector, FindsNothingOnAnEvenImage) {
  const PanoramaGeometry panorama = full_panorama(1440, radians(27), 0.9, kHeight);
  PaperDetector detector({.panorama = panorama, .seen = {}, .height = kHeight, .search = {}});
  for (const int grey : {0, 128, 255}) {
    const cv::Mat1b image(panorama.rows, panorama.width, static_cast<std::uint8_t>(grey));
    EXPECT_TRUE(detector.detect(view_of(image, panorama)).empty());
  }
}

}  // namespace
}  // namespace bole
