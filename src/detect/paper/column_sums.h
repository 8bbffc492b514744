#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace bole {

/// Twice-accumulated column sums of an image that is read once, row by row.
///
/// With P1(i, j) = G(0, j) + .. + G(i, j) and P2(i, j) = P1(0, j) + .. + P1(i, j), the sum over
/// the rows 0 .. r of a window of 2 m + 1 rows, a trapezoid of row weights, is a difference of four
/// rows of P2. The image continues above and below as its first and last row. All sums are modulo
/// 2^32, which their differences do not notice as long as they fit themselves.
class ColumnSums {
 public:
  /// `kept`: the rows of P2 that will be read, any order, rows below the image allowed.
  ColumnSums(int width, int rows, std::vector<int> kept);

  /// Starts a new image.
  void begin();
  /// The next `count` rows, `stride` bytes apart, straight down; `width` pixels of each are read.
  void add_rows(const std::uint8_t* pixels, int stride, int count);
  /// To be called after the last row: completes the rows of P2 below the image.
  void end();

  /// P2 of one of the kept rows, `width` sums; a whole vector may be read from any of them.
  std::span<const std::uint32_t> kept(int row) const;
  /// Row 0 of the image, as sums: above the image P2(-2 - k) = k (k + 1) / 2 of it, k >= 0, and
  /// P2(-1) = 0.
  std::span<const std::uint32_t> first_row() const { return first_row_; }

 private:
  std::uint32_t* kept_row(std::size_t slot) { return p2_.data() + slot * width_; }

  int width_;
  int rows_;
  std::vector<int> kept_;  // ascending; -1 and the last row of the image are always among them
  int row_ = 0;            // the next row of the image
  std::size_t slot_ = 1;   // the first of kept_ that is not before row_
  bool slot_begun_ = false;
  std::vector<std::uint32_t> first_row_, last_row_, p1_;
  std::vector<std::uint32_t> p2_;  // a row for each of kept_
};

}  // namespace bole
