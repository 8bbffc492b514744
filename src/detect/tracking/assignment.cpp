#include "detect/tracking/assignment.h"

#include <algorithm>
#include <limits>

namespace bole {

void Assignment::reserve(int rows, int columns) {
  const auto all = static_cast<std::size_t>(columns) + rows + 1;
  for (std::vector<double>* prices : {&row_price_, &column_price_, &distance_})
    prices->reserve(all);
  for (std::vector<int>* indices : {&row_of_, &previous_, &answer_}) indices->reserve(all);
  done_.reserve(all);
}

double Assignment::cost_of(int row, int column) const {
  if (column < columns_) return cost_[static_cast<std::size_t>(row) * columns_ + column];
  return column - columns_ == row ? unassigned_ : kForbidden;
}

// Grows a tree of shortest alternating paths from `row` until it meets a free column (the row's own
// "left alone" column is always within reach), then flips the path.
void Assignment::add_row(int row) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  std::ranges::fill(distance_, kInfinite);
  std::ranges::fill(done_, 0);
  const auto all = static_cast<int>(distance_.size());
  const int start = all - 1;  // a column of no cost that stands for the row being added
  row_of_[start] = row;
  int column = start;
  while (row_of_[column] >= 0) {
    done_[column] = 1;
    const int from = row_of_[column];
    double step = kInfinite;
    int next = -1;
    for (int c = 0; c < start; ++c) {
      if (done_[c] != 0) continue;
      const double reduced = cost_of(from, c) - row_price_[from] - column_price_[c];
      if (reduced < distance_[c]) {
        distance_[c] = reduced;
        previous_[c] = column;
      }
      if (distance_[c] < step) {
        step = distance_[c];
        next = c;
      }
    }
    for (int c = 0; c < all; ++c) {
      if (done_[c] != 0) {
        row_price_[row_of_[c]] += step;
        column_price_[c] -= step;
      } else {
        distance_[c] -= step;
      }
    }
    column = next;
  }
  for (; column != start; column = previous_[column]) row_of_[column] = row_of_[previous_[column]];
}

std::span<const int> Assignment::solve(std::span<const double> cost, int rows, int columns,
                                       double unassigned) {
  cost_ = cost;
  columns_ = columns;
  unassigned_ = unassigned;
  const auto all = static_cast<std::size_t>(columns) + rows + 1;
  row_price_.assign(rows, 0);
  column_price_.assign(all, 0);
  distance_.resize(all);
  done_.resize(all);
  previous_.assign(all, -1);
  row_of_.assign(all, -1);
  for (int row = 0; row < rows; ++row) add_row(row);

  answer_.assign(rows, -1);
  for (int c = 0; c < columns; ++c) {
    if (row_of_[c] >= 0 && cost_of(row_of_[c], c) < kForbidden) answer_[row_of_[c]] = c;
  }
  return answer_;
}

}  // namespace bole
