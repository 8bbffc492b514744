#pragma once

#include <span>
#include <vector>

namespace bole {

/// Optimal one-to-one assignment of rows to columns (the Hungarian method in its form with shortest
/// augmenting paths and dual prices: Jonker and Volgenant, Computing 38, 1987). Keeps its memory
/// from call to call.
class Assignment {
 public:
  /// No pair of that cost or more is ever made.
  static constexpr double kForbidden = 1e6;

  /// Makes room, so that problems of up to that size allocate nothing.
  void reserve(int rows, int columns);

  /// `cost`: rows x columns, row by row, each from 0 to kForbidden. Answers the column of each row,
  /// -1 for a row that is better left alone; leaving one alone costs `unassigned`. Valid until the
  /// next call.
  std::span<const int> solve(std::span<const double> cost, int rows, int columns,
                             double unassigned);

 private:
  void add_row(int row);
  double cost_of(int row, int column) const;

  // Column c >= columns_ stands for "row c - columns_ is left alone".
  std::span<const double> cost_;
  int columns_ = 0;
  double unassigned_ = 0;
  std::vector<double> row_price_, column_price_, distance_;
  std::vector<int> row_of_, previous_;
  std::vector<char> done_;
  std::vector<int> answer_;
};

}  // namespace bole
