#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace bole {

/// Colours are blue, green, red, as OpenCV has them.
using Colour = cv::Scalar;

/// Of lines on the ground, and of the horizon.
inline const Colour kGround(230, 220, 170), kHorizon(255, 170, 60);

/// From amber for trees that hardly are any to bright green for certain ones.
Colour colour_of_score(double score);

/// Labels on one picture: text on dark plates, readable on anything. A label that would cover an
/// earlier one is left out, so the more important come first.
class Labels {
 public:
  explicit Labels(cv::Mat3b& picture) : picture_(picture) {}

  /// `place` is the middle of the plate's lower border; it is moved so that all of the plate lies
  /// in the picture.
  void add(const std::string& text, cv::Point2d place, const Colour& colour, double size = 0.5);

 private:
  cv::Mat3b& picture_;
  std::vector<cv::Rect> taken_;
};

/// Text alone. `place` is a point of its base line: of its left end, its middle or its right end.
enum class Align { left, middle, right };
void draw_text(cv::Mat3b& picture, const std::string& text, cv::Point2d place, const Colour& colour,
               double size = 0.5, Align align = Align::left);

/// A smooth line through points given to a fraction of a pixel; outlined in black where `outlined`.
void draw_line(cv::Mat3b& picture, const std::vector<cv::Point2d>& points, const Colour& colour,
               int thickness = 1, bool outlined = false);

/// A number with so many digits after the point.
std::string fixed(double value, int digits);

/// Distances at which lines are drawn within [low, high]: every metre up to 8 m, then sparser.
std::vector<double> marked_distances(double low, double high);

}  // namespace bole
