#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "evaluate/drawing.h"

namespace bole {

/// One axis of a plot; ticks stand at round numbers.
struct Axis {
  std::string name;
  double low = 0, high = 1;
};

/// A plot with lines, bars and a legend, on white.
class Plot {
 public:
  Plot(const std::string& title, Axis x, Axis y);

  /// A line through `points` (x, y), with a dot at each where `dots`. An empty name stays out of
  /// the legend.
  void add_line(const std::vector<cv::Point2d>& points, const Colour& colour,
                const std::string& name, bool dots = false);
  /// A filled bar between two corners.
  void add_bar(cv::Point2d from, cv::Point2d to, const Colour& colour,
               const std::string& name = "");

  const cv::Mat3b& picture() const { return canvas_; }

 private:
  cv::Point2d place(cv::Point2d value) const;
  void draw_axes(const std::string& title);
  void add_to_legend(const std::string& name, const Colour& colour);

  Axis x_, y_;
  cv::Mat3b canvas_;
  int legend_lines_ = 0;
};

inline const Colour kOurs(150, 110, 20), kPaper(40, 110, 225), kGuide(170, 170, 170);

}  // namespace bole
