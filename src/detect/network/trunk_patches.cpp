#include "detect/network/trunk_patches.h"

#include <algorithm>

#include "detect/network/patch_kernels.h"

namespace bole {
namespace {

constexpr int kSide = TrunkPatches::kSide;
static_assert(kSide == kPatchSide);
constexpr float kLeastAround = 40, kMostAround = 600;  // columns to each side, of 1440 a turn
constexpr float kMostHalf = 0.5F * kSide * Bands::kMostColumns;  // of the cells of a patch
constexpr float kMostRows = 530;  // from the view's top to a foot, of 1440 columns a turn

// What of the panorama a patch shows.
struct Extent {
  float first = 0, last = 0;  // bands, with their fractions
  float middle = 0;           // column, in the middle of band 0
  float lean = 0;             // columns a band
  float half = 0;             // columns to each side
};

// `scale`: how many times 1440 columns a turn has.
float most_around(float scale) { return std::min(kMostAround * scale, kMostHalf); }

TrunkPatches::Patch read_patch(const Bands& bands, const Extent& extent, bool dark) {
  PatchCells cells;
  const float rows = (extent.last - extent.first) / kSide;
  PatchColumns columns{.cell = 2 * extent.half / kSide,
                       .least = -bands.margin(),
                       .last = bands.width() + bands.margin() - 1};
  constexpr float kUnit = float{PatchCells::kLevels} / (float{Bands::kScale} * float{kPatchParts});
  for (int y = 0; y < kSide; ++y) {
    const auto band_at = [&](int row) {
      return static_cast<int>(extent.first + rows * static_cast<float>(row));
    };
    const int from = std::clamp(band_at(y), 0, bands.count() - 1);
    const int to = std::clamp(band_at(y + 1), from + 1, bands.count());
    for (int band = from; band < to; ++band) {
      columns.first = extent.middle + extent.lean * static_cast<float>(band) - extent.half;
      add_cells(bands.sum(band), columns, cells.sums[y].data());
    }
    cells.factors[y] = kUnit / (columns.cell * static_cast<float>(to - from));
  }
  TrunkPatches::Patch patch;
  standardise_cells(cells, (dark ? 1.0F : -1.0F) * TrunkPatches::kUnits, Bands::kLeastSpread,
                    patch.data());
  return patch;
}

}  // namespace

int patch_reach(double focal) {
  const float scale = static_cast<float>(focal) / kReferenceFocal;
  return static_cast<int>(most_around(scale) + kMostLean * kMostRows * scale) + 1;
}

TrunkPatches read_patches(const Bands& bands, const TrunkShape& shape, int first_band,
                          double focal) {
  const float scale = static_cast<float>(focal) / kReferenceFocal;
  const float width = shape.width();
  const float lean = shape.slope() * Bands::kRows;
  const float foot = shape.foot / Bands::kRows;
  const auto first = static_cast<float>(first_band);
  const Extent trunk{.first = first,
                     .last = std::max(foot + width / Bands::kRows, first + 2),
                     .middle = shape.centre() + lean * (0.5F - foot),
                     .lean = lean,
                     .half = std::min(2 * width, kMostHalf)};
  const Extent around{.first = 0,
                      .last = static_cast<float>(bands.count()),
                      .middle = shape.centre(),
                      .half = std::clamp(6 * width, kLeastAround * scale, most_around(scale))};
  return {.trunk = read_patch(bands, trunk, shape.dark),
          .around = read_patch(bands, around, shape.dark)};
}

}  // namespace bole
