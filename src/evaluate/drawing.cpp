#include "evaluate/drawing.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <opencv2/imgproc.hpp>

namespace bole {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr int kShift = 4;  // lines are drawn in sixteenths of a pixel

cv::Size text_size(const std::string& text, double size, int& below) {
  return cv::getTextSize(text, kFont, size, 1, &below);
}

}  // namespace

Colour colour_of_score(double score) {
  const double t = std::clamp(score, 0.0, 1.0);
  return {60 + 30 * t, 150 + 105 * t, 255 - 165 * t};
}

void draw_text(cv::Mat3b& picture, const std::string& text, cv::Point2d place, const Colour& colour,
               double size, Align align) {
  int below = 0;
  const int width = text_size(text, size, below).width;
  const int left = align == Align::left ? 0 : align == Align::middle ? width / 2 : width;
  const cv::Point origin(cvRound(place.x) - left, cvRound(place.y));
  cv::putText(picture, text, origin, kFont, size, colour, size > 0.9 ? 2 : 1, cv::LINE_AA);
}

void Labels::add(const std::string& text, cv::Point2d place, const Colour& colour, double size) {
  constexpr int kMargin = 3;
  int below = 0;
  const cv::Size letters = text_size(text, size, below);
  const cv::Size plate(letters.width + 2 * kMargin, letters.height + below + 2 * kMargin);
  const auto inside = [](double wanted, int length, int available) {
    return std::clamp(cvRound(wanted), 0, std::max(0, available - length));
  };
  const cv::Rect rect({inside(place.x - plate.width / 2.0, plate.width, picture_.cols),
                       inside(place.y - plate.height, plate.height, picture_.rows)},
                      plate);
  const auto covers = [&](const cv::Rect& other) { return !(other & rect).empty(); };
  if (std::any_of(taken_.begin(), taken_.end(), covers)) return;
  taken_.push_back(rect);
  cv::Mat3b part = picture_(rect & cv::Rect({0, 0}, picture_.size()));
  part *= 0.35;
  cv::putText(picture_, text, {rect.x + kMargin, rect.y + kMargin + letters.height}, kFont, size,
              colour, 1, cv::LINE_AA);
}

void draw_line(cv::Mat3b& picture, const std::vector<cv::Point2d>& points, const Colour& colour,
               int thickness, bool outlined) {
  std::vector<cv::Point> fine;
  fine.reserve(points.size());
  for (const cv::Point2d& p : points) {
    fine.emplace_back(cvRound(p.x * (1 << kShift)), cvRound(p.y * (1 << kShift)));
  }
  if (outlined) {
    cv::polylines(picture, fine, false, {0, 0, 0}, thickness + 2, cv::LINE_AA, kShift);
  }
  cv::polylines(picture, fine, false, colour, thickness, cv::LINE_AA, kShift);
}

std::string fixed(double value, int digits) {
  char text[32];
  (void)std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

std::vector<double> marked_distances(double low, double high) {
  std::vector<double> distances;
  for (const double d : {1, 2, 3, 4, 5, 6, 7, 8, 10, 15, 20, 30, 40, 60, 80, 100, 150, 200}) {
    if (low <= d && d <= high) distances.push_back(d);
  }
  return distances;
}

}  // namespace bole
