#pragma once

#include <algorithm>
#include <cmath>

namespace bole {

/// The root of `f`, which is negative at `low` and not negative at `high`, to machine precision:
/// Newton's steps, and a bisection where one would leave what is known to hold the root. `slope` is
/// the derivative of f.
template <class Function, class Slope>
double root_between(const Function& f, const Slope& slope, double low, double high) {
  double x = (low + high) / 2;
  for (int step = 0; step < 100; ++step) {
    const double error = f(x);
    (error < 0 ? low : high) = x;
    const double newton = x - error / slope(x);
    const double next = newton > low && newton < high ? newton : (low + high) / 2;
    if (std::abs(next - x) <= 1e-13 * (1 + x)) break;
    x = next;
  }
  return x;
}

/// How far from 0 a function grows whose derivative is `slope`: looked for in steps of `step`, at
/// most up to `end`.
template <class Slope>
double grows_until(const Slope& slope, double step, double end) {
  double x = 0;
  while (x < end && slope(x + step) > 0) x += step;
  return std::min(x, end);
}

}  // namespace bole
