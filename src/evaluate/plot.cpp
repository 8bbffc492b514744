#include "evaluate/plot.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace bole {
namespace {

constexpr int kWidth = 900, kHeight = 680;
constexpr int kLeft = 90, kRight = 30, kTop = 60, kBottom = 75;
const Colour kInk(50, 50, 50), kGrid(232, 232, 232);

// The smallest of 1, 2, 5 times a power of ten that divides the axis into at most `most` parts.
double tick_step(const Axis& axis, int most) {
  const double least = (axis.high - axis.low) / most;
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1, 2, 5}) {
    if (factor * power >= least * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

std::vector<double> ticks(const Axis& axis, double step) {
  std::vector<double> values;
  for (double k = std::ceil(axis.low / step - 1e-9); k * step <= axis.high + 1e-9 * step; ++k) {
    values.push_back(k * step + 0.0);  // no minus before zero
  }
  return values;
}

int digits_of(double step) { return std::max(0, static_cast<int>(-std::floor(std::log10(step)))); }

}  // namespace

Plot::Plot(const std::string& title, Axis x, Axis y)
    : x_(std::move(x)), y_(std::move(y)), canvas_(kHeight, kWidth, cv::Vec3b(255, 255, 255)) {
  draw_axes(title);
}

cv::Point2d Plot::place(cv::Point2d value) const {
  const auto share = [](double v, const Axis& axis) {
    return std::clamp((v - axis.low) / (axis.high - axis.low), 0.0, 1.0);
  };
  return {kLeft + share(value.x, x_) * (kWidth - kLeft - kRight),
          kHeight - kBottom - share(value.y, y_) * (kHeight - kTop - kBottom)};
}

void Plot::draw_axes(const std::string& title) {
  const double step_x = tick_step(x_, 10), step_y = tick_step(y_, 10);
  for (const double x : ticks(x_, step_x)) {
    draw_line(canvas_, {place({x, y_.low}), place({x, y_.high})}, kGrid);
    draw_text(canvas_, fixed(x, digits_of(step_x)), place({x, y_.low}) + cv::Point2d(0, 22), kInk,
              0.5, Align::middle);
  }
  for (const double y : ticks(y_, step_y)) {
    draw_line(canvas_, {place({x_.low, y}), place({x_.high, y})}, kGrid);
    draw_text(canvas_, fixed(y, digits_of(step_y)), place({x_.low, y}) + cv::Point2d(-10, 5), kInk,
              0.5, Align::right);
  }
  draw_line(canvas_, {place({x_.low, y_.high}), place({x_.low, y_.low}), place({x_.high, y_.low})},
            kInk);
  draw_text(canvas_, title, {kLeft, 34}, kInk, 0.75);
  draw_text(canvas_, y_.name, {kLeft, kTop - 8.0}, kInk, 0.5);
  draw_text(canvas_, x_.name, {kWidth - kRight, kHeight - 20.0}, kInk, 0.5, Align::right);
}

void Plot::add_line(const std::vector<cv::Point2d>& points, const Colour& colour,
                    const std::string& name, bool dots) {
  std::vector<cv::Point2d> placed;
  placed.reserve(points.size());
  for (const cv::Point2d& point : points) placed.push_back(place(point));
  draw_line(canvas_, placed, colour, 2);
  if (dots) {
    for (const cv::Point2d& p : placed) cv::circle(canvas_, p, 5, colour, cv::FILLED, cv::LINE_AA);
  }
  add_to_legend(name, colour);
}

void Plot::add_bar(cv::Point2d from, cv::Point2d to, const Colour& colour,
                   const std::string& name) {
  cv::rectangle(canvas_, place(from), place(to), colour, cv::FILLED, cv::LINE_AA);
  add_to_legend(name, colour);
}

void Plot::add_to_legend(const std::string& name, const Colour& colour) {
  if (name.empty()) return;
  const double y = kTop + 22.0 + 24 * legend_lines_++;
  const double right = kWidth - kRight - 14;
  draw_line(canvas_, {{right - 26, y - 5}, {right, y - 5}}, colour, 4);
  draw_text(canvas_, name, {right - 36, y}, kInk, 0.5, Align::right);
}

}  // namespace bole
