#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "detect/contrast/bands.h"
#include "detect/contrast/edge_kernels.h"
#include "detect/contrast/templates.h"

namespace bole {

/// Columns a radian of the panorama that limits in columns and rows are meant for.
inline constexpr float kReferenceFocal = 1440 / 6.2831853F;
/// Columns a row that an edge may lean by.
inline constexpr float kMostLean = 0.15F;

/// A trunk's outline in the panorama: two straight edges that end at the foot. Columns are
/// continuous, 0 at the left border of column 0; rows likewise.
struct TrunkShape {
  float foot = 0;                         ///< row where the visible trunk ends
  float left = 0, right = 0;              ///< columns of the edges at the foot
  float left_slope = 0, right_slope = 0;  ///< columns a row
  bool dark = true;

  float width() const { return right - left; }
  float centre() const { return 0.5F * (left + right); }
  float slope() const { return 0.5F * (left_slope + right_slope); }
};

/// The same edges, ended at another row.
TrunkShape ended_at(const TrunkShape& shape, float foot);

/// Rows: the unit of a foot's shift, and what the fine rows about a foot are apart.
float foot_unit(const TrunkShape& shape, double focal);

/// How well two lines describe a trunk's edges.
struct EdgeFit {
  float contrast_left = 0, contrast_right = 0;  ///< mean clipped response along the line, at most 1
  float above_left = 0, above_right = 0;        ///< the same of the part above the horizon
  float agreement = 0;        ///< share of bands below the horizon where both edges respond
  float agreement_above = 0;  ///< share of bands above it
  float scatter_left = 0, scatter_right = 0;  ///< of the edges' places about the lines, columns
};

/// Places both edges as lines: a search over shifts and slopes for the most contrast along all
/// bands, then straight lines through the sub-column places of the contrast's peaks. The root flare
/// is left out.
class EdgeFitter {
 public:
  explicit EdgeFitter(const DetectorSetup& setup);

  /// The shape a candidate is refined to; false when there is nothing to fit.
  bool fit(const Bands& bands, const Candidate& candidate, TrunkShape& shape, EdgeFit& fit) const;

  /// Other rows at which the trunk between these edges may end: where its contrast, summed down the
  /// edges, has a peak and then falls. Best first; returns how many.
  static constexpr int kFeetByContrast = 3, kOtherFeet = 6;
  int other_feet(const Bands& bands, const TrunkShape& shape,
                 std::array<float, kOtherFeet>& feet) const;

  /// Places the edges of a shape anew, from where they are; then `fit` describes them.
  void refine(const Bands& bands, TrunkShape& shape, EdgeFit& fit) const;

  /// The first band that is seen in all columns from `left` to `right`.
  int first_band(float left, float right) const;

  /// The row where the camera's sight of this column ends below: a trunk that reaches it stands
  /// farther down.
  float last_row(float column) const;

 private:
  struct Extent {
    int first = 0, last = 0;  // bands
    int count() const { return std::max(0, last - first); }
  };
  // What of a trunk is straight: from the upper border to above the root flare.
  Extent extent(const Bands& bands, float left, float width, float foot) const;
  EdgeBands along(const Bands& bands, Extent extent, float foot, int flank) const;
  // Moves the lines, left and right, onto their edges; how far the edges' places scatter about
  // them, columns.
  std::array<float, 2> place(const EdgeBands& bands, std::array<EdgeLine, 2>& lines,
                             int sign) const;
  // Where searched trees of this width meet level ground, as contrast may tell nothing of a foot.
  int add_level_feet(const TrunkShape& shape, std::array<float, kOtherFeet>& feet, int count) const;
  void judge(const EdgeBands& bands, const TrunkShape& shape, EdgeFit& fit) const;

  int width_, horizon_band_;
  float horizon_;                // row
  float farthest_foot_;          // of a searched tree on level ground: rows below the horizon
  Bounds level_foot_;            // of searched trees there: rows below the horizon per column
  int margin_;                   // columns before the first and after the last one
  std::vector<int> first_seen_;  // band, for each column and those of the margins
  std::vector<int> last_seen_;   // row, likewise
};

}  // namespace bole
