#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "detect/paper/column_sums.h"
#include "detect/paper/paper_templates.h"
#include "geometry/panorama.h"

namespace bole {

/// The paper's S in closed form.
///
/// All of S is linear in the image, and the sum over rows of a filtered image is the filter of a
/// weighted sum over rows. A bar is the same in each of its 2 m + 1 rows, so the row weights are a
/// trapezoid, W(j) = P2(r + m) - P2(m - 1) - P2(r - m - 1) + P2(-m - 2) with r the foot's row, and
/// S is W filtered along the row by the bar's profile.
///
/// The image continues above and below as its first and last row, and to the sides round the full
/// turn, or as its outer columns where less is kept.
class PaperScores {
 public:
  /// Throws ConfigError when a template is so large that its sums would not fit.
  PaperScores(const PanoramaGeometry& panorama, std::vector<PaperTemplate> templates);

  const std::vector<PaperTemplate>& templates() const { return templates_; }

  /// Takes the panorama's rows, all of them, from the top down: begin(), add_rows(), end().
  ColumnSums& rows() { return sums_; }

  /// S of template k at each column, after all rows; valid until the next call.
  std::span<const float> scores(std::size_t k);

 private:
  struct Reads {
    int bottom, top, above;         // the rows of P2 that W is made of
    std::uint32_t first_row_times;  // and how much of the first row
  };
  static Reads reads_of(const PaperTemplate& t);
  static std::vector<int> rows_read(const std::vector<PaperTemplate>& templates);
  void continue_to_the_sides(int reach);

  std::vector<PaperTemplate> templates_;
  int width_;
  bool wraps_;
  int margin_;                                // columns in front of the first
  std::vector<std::vector<float>> profiles_;  // of the bars, over s^2 n a
  ColumnSums sums_;
  std::vector<float> weighted_;  // W, with margins
  std::vector<float> scores_;
};

}  // namespace bole
