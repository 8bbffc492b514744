#include <algorithm>
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "detect/paper/paper_scores.h"
#include "evaluate/image_detector.h"
#include "support/shared_camera.h"
#include "unit/detect/paper_oracle.h"

namespace bole {
namespace {

namespace fs = std::filesystem;

// The closed form against the literal filter on frames, at every depth, size and column.
class PaperOnFrames : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(data("sim_omni"))) GTEST_SKIP() << data("sim_omni") << " is not there";
    fs::create_directories(folder_);
  }

  static fs::path data(const std::string& name) {
    return fs::path(BOLE_SHARED_DIR) / "data" / name;
  }

  // A mask with a ragged edge all round, that hides a whole wedge from the centre outwards: some
  // panorama columns see nothing at all.
  std::string ragged_mask(const std::string& name) const {
    cv::Mat1b mask = cv::imread((data(name) / "mask.png").string(), cv::IMREAD_GRAYSCALE);
    cv::RNG rng(1);
    const cv::Point centre(mask.cols / 2, mask.rows / 2);
    for (int k = 0; k < 400; ++k) {
      const double angle = rng.uniform(0.0, 2 * CV_PI), radius = rng.uniform(0.3, 0.5) * mask.rows;
      const cv::Point bite(cvRound(radius * std::cos(angle)), cvRound(radius * std::sin(angle)));
      cv::circle(mask, centre + bite, rng.uniform(1, 12), 0, cv::FILLED);
    }
    cv::fillConvexPoly(mask, std::vector<cv::Point>{centre, {0, 100}, {0, 0}, {250, 0}}, 0);
    const std::string file = (folder_ / (name + "_ragged.png")).string();
    cv::imwrite(file, mask);
    return file;
  }

  void expect_equal(const std::string& name, const std::string& file, const std::string& search,
                    const std::string& mask) {
    ImageDetector images(write_shared_camera(data(name), folder_ / name, search, mask),
                         DetectorMode::paper);
    const PanoramaView view = images.warp(view_of(read_picture(data(name) / file)));
    const PanoramaGeometry& panorama = images.table().panorama();
    const cv::Mat1b green(panorama.rows, panorama.width, const_cast<std::uint8_t*>(view.pixels),
                          view.stride);
    const CameraConfig& config = images.camera().config;
    PaperScores fast(panorama, paper_templates(panorama, config.mount.height, config.search));
    fast.rows().begin();
    fast.rows().add_rows(view.pixels, view.stride, panorama.rows);
    fast.rows().end();
    double error = 0, low = 1e9, high = -1e9;
    for (std::size_t k = 0; k < fast.templates().size(); ++k) {
      const cv::Mat1d oracle = literal_paper_scores(green, panorama.wraps(), fast.templates()[k]);
      const std::span<const float> scores = fast.scores(k);
      for (int j = 0; j < panorama.width; ++j) {
        error = std::max(error, std::abs(scores[j] - oracle(j)));
        low = std::min(low, oracle(j));
        high = std::max(high, oracle(j));
      }
    }
    EXPECT_LT(error, 1e-4 * (high - low)) << name << " " << file;
    RecordProperty("error_over_range", std::to_string(error / (high - low)));
  }

  const std::string search_ = "range_m = [1.0, 8.0]\ndiameter_m = [0.2, 0.8]";

 private:
  const fs::path folder_ = fs::path(testing::TempDir()) / "paper_frames_test";
};

TEST_F(PaperOnFrames, EqualsTheLiteralFilterOnASimulatedFrame) {
  expect_equal("sim_omni", "frame_0003.jpg", search_, "");
}

TEST_F(PaperOnFrames, EqualsTheLiteralFilterWithoutAMask) {
  expect_equal("sim_omni", "frame_0011.jpg", search_, "none");
}

TEST_F(PaperOnFrames, EqualsTheLiteralFilterUnderARaggedMask) {
  expect_equal("sim_omni", "frame_0017.jpg", search_, ragged_mask("sim_omni"));
}

TEST_F(PaperOnFrames, EqualsTheLiteralFilterInARealWood) {
  expect_equal("real_omni", "forest.png", "range_m = [1, 8]\ndiameter_m = [0.1, 1.2]", "");
}

}  // namespace
}  // namespace bole
