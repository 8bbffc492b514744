#pragma once

#include <array>
#include <vector>

#include "detect/contrast/bands.h"
#include "detect/contrast/trunk_shape.h"
#include "detect/network/foot_patch.h"

namespace bole {

/// What the network is shown of a candidate: the picture about it in coordinates of its own shape,
/// so that size, place, lean, light and polarity are taken out, and a few numbers. Where the trunk
/// stands is kept from it: what a foot's row says is the range's posterior to judge, which knows
/// how little it says where the ground is not level.
struct TrunkFeatures {
  static constexpr int kHeights = 11;   ///< cells along the trunk, two of them below the foot
  static constexpr int kAcross = 12;    ///< cells across, out to one width beside it
  static constexpr int kFootRows = 16;  ///< fine rows about the foot
  static constexpr int kStrips = 3;     ///< of each: left of the trunk, its core, right of it
  static constexpr int kNumbers = 19;
  static constexpr int kRowNumbers = 7;  ///< of each row of cells: see row_contrasts
  static constexpr int kRowContrasts = kRowNumbers * kHeights + kHeights - 1;

  // In this order, then the log of the foot's contrast.
  static constexpr int kGrid = kHeights * kAcross, kFoot = kFootRows * kStrips;
  static constexpr int kCount = kGrid + kFoot + kNumbers + kRowContrasts + 1;
  using Values = std::array<float, kCount>;
};

struct RowLevels;

class FeatureReader {
 public:
  explicit FeatureReader(const DetectorSetup& setup);

  void read(const Bands& bands, const PanoramaView& panorama, const TrunkShape& shape,
            const EdgeFit& fit, int first_band, TrunkFeatures::Values& out) const;
  /// All but what is about the foot, which is left as it was; rows of cells are as strong in
  /// contrast as they are.
  void glance(const Bands& bands, const TrunkShape& shape, const EdgeFit& fit, int first_band,
              TrunkFeatures::Values& out) const;
  /// `bands`: those of the panorama.
  FootPatch::Values foot_patch(const Bands& bands, const PanoramaView& panorama,
                               const TrunkShape& shape) const {
    return read_foot_patch(panorama, wraps_, log_above(bands.veil()), shape, focal_);
  }

 private:
  enum class Care { glance, full };
  // Returns the grid's spread, log brightness; so does read_grid.
  float read_but_foot(const Bands& bands, const TrunkShape& shape, const EdgeFit& fit,
                      int first_band, Care care, RowLevels& levels,
                      TrunkFeatures::Values& out) const;
  float read_grid(const Bands& bands, const TrunkShape& shape, int first_band, Care care,
                  float* out) const;
  void read_foot(const Bands& bands, const PanoramaView& panorama, const TrunkShape& shape,
                 float spread, float* out) const;
  const float* log_above(int veil) const { return log_.data() + kThickestVeil - veil; }

  int last_band_;
  bool wraps_;
  double focal_;
  std::vector<float> log_;  // of quarters of a grey level, from -kThickestVeil on
};

}  // namespace bole
