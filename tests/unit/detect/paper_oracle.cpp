#include "unit/detect/paper_oracle.h"

#include <cmath>

#include <opencv2/imgproc.hpp>

namespace bole {
namespace {

cv::Mat1d bar_filter(double s) {
  const int m = static_cast<int>(s);
  cv::Mat1d bar(2 * m + 1, 2 * m + 1);
  for (int y = -m; y <= m; ++y) {
    for (int x = -m; x <= m; ++x) {
      bar(y + m, x + m) = std::exp(-x * x / (2 * s * s)) * std::cos(CV_PI * x / s);
    }
  }
  return bar;
}

}  // namespace

cv::Mat1d literal_paper_scores(const cv::Mat1b& panorama, bool wraps, const PaperTemplate& t) {
  const int m = static_cast<int>(t.width_px);
  cv::Mat1d wide;
  panorama.convertTo(wide, CV_64F);
  cv::copyMakeBorder(wide, wide, 0, 0, m, m, wraps ? cv::BORDER_WRAP : cv::BORDER_REPLICATE);
  cv::Mat1d filtered;
  cv::filter2D(wide, filtered, CV_64F, bar_filter(t.width_px), {-1, -1}, 0, cv::BORDER_REPLICATE);
  const int n = t.foot_row + 1;
  cv::Mat1d sum;
  cv::reduce(filtered(cv::Rect(m, 0, panorama.cols, n)), sum, 0, cv::REDUCE_SUM);
  sum /= t.width_px * t.width_px * n * t.foot_distance;
  return sum;
}

}  // namespace bole
