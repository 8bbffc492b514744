#include "detect/trunk_features.h"

#include <algorithm>
#include <cmath>

#include "detect/grid_kernels.h"

namespace bole {
namespace {

using F = TrunkFeatures;

// Borders of the cells across, in widths from the middle.
constexpr std::array<float, F::kAcross + 1> kBorders = {
    -1.5F, -1.0F, -0.75F, -0.55F, -0.4F, -0.2F, 0.0F, 0.2F, 0.4F, 0.55F, 0.75F, 1.0F, 1.5F};
constexpr float kReference = 1440 / 6.2831853F;  // the focal length that pixel limits are meant for
constexpr float kLeastSpread = 0.06F;            // of log brightness

// Whole numbers near columns and rows, which stay far from the limits.
int floor_of(float x) { return static_cast<int>(x + 16384.0F) - 16384; }
int nearest(float x) { return floor_of(x + 0.5F); }

}  // namespace

float foot_unit(const TrunkShape& shape, double focal) {
  const float scale = static_cast<float>(focal) / kReference;
  return std::clamp(0.12F * shape.width(), 0.8F * scale, 5.0F * scale);
}

FeatureReader::FeatureReader(const DetectorSetup& setup)
    : rows_(setup.panorama.rows),
      width_(setup.panorama.width),
      last_band_(setup.panorama.rows / Bands::kRows),
      wraps_(setup.panorama.wraps()),
      focal_(setup.panorama.focal()),
      log_(1024) {
  for (int i = 0; i < 1024; ++i) log_[i] = std::log(static_cast<float>(i) / 4 + Bands::kBlackLevel);
}

float FeatureReader::read_grid(const Bands& bands, const TrunkShape& shape, int first_band,
                               float* out, float* mean) const {
  const float unit =
      std::clamp(0.3F * shape.width(), 3.0F, 14.0F * static_cast<float>(focal_) / kReference);
  const float top = static_cast<float>(first_band * Bands::kRows);
  std::array<float, F::kHeights + 1> borders;
  const float part = std::max(shape.foot - 4 * unit - top, 6.0F) / 6;
  borders[0] = shape.foot + 2 * unit;
  borders[1] = shape.foot + unit;
  borders[2] = shape.foot;
  borders[3] = shape.foot - unit;
  borders[4] = shape.foot - 2 * unit;
  borders[5] = shape.foot - 4 * unit;
  for (int i = 0; i < 6; ++i) borders[6 + i] = borders[5] - part * static_cast<float>(i + 1);

  const int last = std::min(
      {last_band_, static_cast<int>(borders[0] / Bands::kRows) + 1, first_band + kMostGridBands});
  const int first = std::min(first_band, last - 1);
  const float w = shape.width();
  const float row = (static_cast<float>(first) + 0.5F) * Bands::kRows - shape.foot;
  const bool narrow = 0.5F * w + 1 < static_cast<float>(Bands::kMostColumns);
  CellColumns cells{.sums = bands.sum(first),
                    .pitch = bands.pitch(),
                    .coarse = narrow ? nullptr : bands.coarse(first),
                    .coarse_pitch = bands.coarse_pitch(),
                    .margin = bands.margin(),
                    .bands = last - first,
                    .middle = shape.centre() + shape.slope() * row,
                    .lean = shape.slope() * Bands::kRows};
  for (int i = 0; i < kGridLanes; ++i) cells.borders[i] = kBorders[std::min(i, F::kAcross)] * w;
  CellSums sums;
  sum_cells(cells, sums);

  const float sign = shape.dark ? 1.0F : -1.0F;
  std::array<float, F::kAcross> per_cell;
  for (int i = 0; i < F::kAcross; ++i) {
    per_cell[i] =
        sign / (float{Bands::kScale * CellSums::kParts} * (kBorders[i + 1] - kBorders[i]) * w);
  }
  // A place among the bands, from the first one's upper border.
  struct Place {
    int band;
    float rest;
  };
  const auto place = [&](float row_at) {
    const float b = std::clamp(row_at / Bands::kRows - static_cast<float>(first), 0.0F,
                               static_cast<float>(last - first) - 1e-3F);
    const auto whole = static_cast<int>(b);
    return Place{whole, b - static_cast<float>(whole)};
  };
  float total = 0, squares = 0;
  for (int h = 0; h < F::kHeights; ++h) {
    const float bottom = static_cast<float>(last * Bands::kRows),
                start = static_cast<float>(first * Bands::kRows);
    const float low = std::clamp(borders[h], start + 1, bottom);
    const float high = std::clamp(borders[h + 1], start, low - 1);
    const Place from = place(high), to = place(low);
    const auto *from_sums = sums.at[from.band], *to_sums = sums.at[to.band];
    const float per_band = Bands::kRows / (low - high);
    for (int i = 0; i < F::kAcross; ++i) {
      const auto beyond = [i](const std::int32_t* at, float rest) {
        return rest * static_cast<float>(at[kGridLanes + i] - at[i]);
      };
      const float sum = static_cast<float>(to_sums[i] - from_sums[i]) + beyond(to_sums, to.rest) -
                        beyond(from_sums, from.rest);
      const float value = sum * per_band * per_cell[i];
      out[h * F::kAcross + i] = value;
      total += value;
      squares += value * value;
    }
  }
  constexpr int kCells = F::kHeights * F::kAcross;
  *mean = total / kCells;
  const float spread = std::sqrt(std::max(0.0F, squares / kCells - *mean * *mean));
  const float scale = 1 / std::max(spread, kLeastSpread);
  for (int i = 0; i < kCells; ++i) out[i] = (out[i] - *mean) * scale;
  return spread;
}

// The sums of strips that may lead beyond a border: continued round the turn, or by its pixel.
std::array<int, RowStrips::kCount> FeatureReader::sum_round(const std::uint8_t* row,
                                                            const RowStrips& strips) const {
  std::array<int, RowStrips::kCount> sums{};
  for (const int turn : {-1, 0, 1}) {
    const int begin = turn * width_;
    if (strips.last[2] <= begin || strips.first[0] >= begin + width_) continue;
    for (int k = 0; k < RowStrips::kCount; ++k) {
      const int first = std::max(strips.first[k], begin) - begin;
      const int last = std::min(strips.last[k], begin + width_) - begin;
      const int n = std::max(0, last - first);
      if (turn == 0 || wraps_) {
        if (n > 0) sums[k] += sum_pixels(row + first, n);
      } else {
        sums[k] += n * row[turn < 0 ? 0 : width_ - 1];
      }
    }
  }
  return sums;
}

// Mean log brightness left of the trunk, in its core and right of it.
FeatureReader::Strips FeatureReader::strips(const PanoramaView& panorama, int row, float middle,
                                            float width) const {
  const float gap = 0.5F * width + std::max(1.0F, 0.1F * width);
  const float far = gap + std::max(2.0F, 0.5F * width), core = 0.28F * width;
  RowStrips bounds{{nearest(middle - far), nearest(middle - core), nearest(middle + gap)},
                   {nearest(middle - gap), nearest(middle + core), nearest(middle + far)}};
  bounds.last[1] = std::max(bounds.last[1], bounds.first[1] + 1);
  const std::uint8_t* pixels = panorama.row(row);
  // Narrow trunks, most of them, lie within one vector or two.
  const bool within = bounds.first[0] >= 0 && bounds.last[2] <= width_ &&
                      pixels - panorama.pixels + bounds.first[0] >= RowStrips::kUnderread;
  const bool narrow = bounds.last[2] - bounds.first[0] <= 64;
  const std::array<int, F::kStrips> sums =
      within && narrow ? sum_strips(pixels, bounds) : sum_round(pixels, bounds);
  Strips means;
  for (int k = 0; k < F::kStrips; ++k) {
    const int n = bounds.last[k] - bounds.first[k];
    // A quotient of whole numbers, rounded down: the half keeps it off the next one.
    means[k] =
        log_[static_cast<int>((4 * static_cast<float>(sums[k]) + 0.5F) / static_cast<float>(n))];
  }
  return means;
}

void FeatureReader::read_foot(const PanoramaView& panorama, const TrunkShape& shape, float spread,
                              float* out) const {
  const float unit = foot_unit(shape, focal_);
  const float sign = shape.dark ? 1.0F : -1.0F;
  std::array<Strips, F::kFootRows> lines{};
  // Neighbouring lines share rows where the unit is small.
  struct {
    int row = -1;
    Strips means;
  } known[2];
  constexpr int kRowsAbove = F::kFootRows / 2;
  for (int j = 0; j < F::kFootRows; ++j) {
    const float place = shape.foot + (static_cast<float>(j - kRowsAbove) + 0.5F) * unit - 0.5F;
    const float spacing = std::max(1.0F, 0.5F * unit);
    const float high = spacing > 1 ? place - 0.5F * spacing : std::floor(place);
    for (int k = 0; k < 2; ++k) {
      const float at = high + static_cast<float>(k) * spacing;
      const int i = std::clamp(nearest(at), 0, rows_ - 1);
      const float weight = spacing > 1 ? 0.5F : k == 0 ? 1 - (place - high) : place - high;
      auto& [row, means] = known[i & 1];
      if (row != i) {
        const float below = static_cast<float>(i) + 0.5F - shape.foot;
        means = strips(panorama, i, shape.centre() + shape.slope() * below, shape.width());
      }
      row = i;
      for (int strip = 0; strip < F::kStrips; ++strip) lines[j][strip] += weight * means[strip];
    }
  }
  // The trunk's own brightness above the foot is the reference.
  float core = 0;
  for (int j = 0; j < kRowsAbove; ++j) core += lines[j][1];
  core /= kRowsAbove;
  const float scale = sign / std::max(spread, kLeastSpread);
  for (int j = 0; j < F::kFootRows; ++j) {
    const auto& s = lines[j];
    const float values[3] = {s[0] - s[1], s[1] - core, s[2] - s[1]};
    for (int k = 0; k < F::kStrips; ++k)
      out[j * F::kStrips + k] = std::clamp(values[k] * scale, -4.0F, 4.0F);
  }
}

void FeatureReader::read(const Bands& bands, const PanoramaView& panorama, const TrunkShape& shape,
                         const EdgeFit& fit, int first_band, F::Values& out) const {
  float mean = 0;
  float* values = out.data();
  const float spread = read_grid(bands, shape, first_band, values, &mean);
  values += F::kHeights * F::kAcross;
  read_foot(panorama, shape, spread, values);
  values += F::kFootRows * F::kStrips;

  const auto f = static_cast<float>(focal_);
  const float w = shape.width();
  const float top = static_cast<float>(first_band * Bands::kRows);
  const float numbers[F::kNumbers] = {
      std::log(w * kReference / (20 * f)),
      std::log(w / 6),
      spread,
      shape.dark ? 1.0F : -1.0F,
      std::log(std::max(4.0F, shape.foot - top) / w),
      fit.contrast_left,
      fit.contrast_right,
      std::min(fit.contrast_left, fit.contrast_right),
      fit.above_left,
      fit.above_right,
      std::min(fit.above_left, fit.above_right),
      fit.agreement,
      fit.agreement_above,
      fit.scatter_left,
      fit.scatter_right,
      std::abs(shape.left_slope - shape.right_slope) * 20,
      std::abs(shape.slope()) * 20,
      (shape.left_slope - shape.right_slope) * 20,
      shape.slope() * 20,
  };
  std::copy(std::begin(numbers), std::end(numbers), values);
}

}  // namespace bole
