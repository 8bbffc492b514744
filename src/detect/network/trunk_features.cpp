#include "detect/network/trunk_features.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "detect/network/foot_kernels.h"
#include "detect/network/grid_kernels.h"
#include "detect/network/row_contrasts.h"

namespace bole {
namespace {

using F = TrunkFeatures;

// Borders of the cells across, in widths from the middle.
constexpr std::array<float, F::kAcross + 1> kBorders = {
    -1.5F, -1.0F, -0.75F, -0.55F, -0.4F, -0.2F, 0.0F, 0.2F, 0.4F, 0.55F, 0.75F, 1.0F, 1.5F};
constexpr int kTall = 48;  // bands

}  // namespace

FeatureReader::FeatureReader(const DetectorSetup& setup)
    : last_band_(setup.panorama.rows / Bands::kRows),
      wraps_(setup.panorama.wraps()),
      focal_(setup.panorama.focal()),
      log_(kThickestVeil + kLogLevels, std::log(float{Bands::kBlackLevel})) {
  for (int i = 0; i < kLogLevels; ++i)
    log_[kThickestVeil + i] = std::log(static_cast<float>(i) / 4 + Bands::kBlackLevel);
}

float FeatureReader::read_grid(const Bands& bands, const TrunkShape& shape, int first_band,
                               Care care, float* out) const {
  const float unit =
      std::clamp(0.3F * shape.width(), 3.0F, 14.0F * static_cast<float>(focal_) / kReferenceFocal);
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
  // Of tall trunks every other band tells enough for a glance.
  const int step = care == Care::glance && last - first >= kTall ? 2 : 1;
  const int count = (last - first) / step;
  const float rows_a_band = Bands::kRows * static_cast<float>(step);
  const float w = shape.width();
  const float row = (static_cast<float>(first) + 0.5F) * Bands::kRows - shape.foot;
  const bool narrow = 0.5F * w + 1 < static_cast<float>(Bands::kMostColumns);
  CellColumns columns{.sums = bands.sum(first),
                      .pitch = step * bands.pitch(),
                      .coarse = narrow ? nullptr : bands.coarse(first),
                      .coarse_pitch = step * bands.coarse_pitch(),
                      .margin = bands.margin(),
                      .bands = count,
                      .middle = shape.centre() + shape.slope() * row,
                      .lean = shape.slope() * rows_a_band};
  for (int i = 0; i < kGridLanes; ++i) columns.borders[i] = kBorders[std::min(i, F::kAcross)] * w;
  const float sign = shape.dark ? 1.0F : -1.0F;
  for (int i = 0; i < F::kAcross; ++i) {
    columns.factors[i] =
        sign / (float{Bands::kScale * kCellParts} * (kBorders[i + 1] - kBorders[i]) * w);
  }

  std::array<CellRows, F::kHeights> rows;
  const float bottom = static_cast<float>(last * Bands::kRows),
              start = static_cast<float>(first * Bands::kRows);
  const auto band_of = [&](float row_at) {
    return std::clamp((row_at - start) / rows_a_band, 0.0F, static_cast<float>(count) - 1e-3F);
  };
  for (int h = 0; h < F::kHeights; ++h) {
    const float low = std::clamp(borders[h], start + 1, bottom);
    const float high = std::clamp(borders[h + 1], start, low - 1);
    const float from = band_of(high), to = band_of(low);
    CellRows& r = rows[h];
    r.from = static_cast<int>(from);
    r.to = static_cast<int>(to);
    r.from_rest = from - static_cast<float>(r.from);
    r.to_rest = to - static_cast<float>(r.to);
    r.factor = rows_a_band / (low - high);
  }
  GridValues values;
  const auto [mean, spread] = read_cells(columns, rows, values);
  const float scale = 1 / std::max(spread, Bands::kLeastSpread);
  for (const auto& cells : values)
    for (int i = 0; i < F::kAcross; ++i) *out++ = (cells[i] - mean) * scale;
  return spread;
}

void FeatureReader::read_foot(const Bands& bands, const PanoramaView& panorama,
                              const TrunkShape& shape, float spread, float* out) const {
  static_assert(F::kFootRows == FootLines::kLines && F::kStrips == FootLines::kStrips);
  FootLines lines;
  read_foot_lines(panorama, wraps_, log_above(bands.veil()),
                  {.row = shape.foot,
                   .middle = shape.centre(),
                   .lean = shape.slope(),
                   .width = shape.width(),
                   .unit = foot_unit(shape, focal_)},
                  lines);
  const auto& [left, middle, right] = lines.at;
  // The trunk's own brightness above the foot is the reference.
  constexpr int kRowsAbove = F::kFootRows / 2;
  const float core =
      std::accumulate(middle.begin(), middle.begin() + kRowsAbove, 0.0F) / kRowsAbove;
  const float scale = (shape.dark ? 1.0F : -1.0F) / std::max(spread, Bands::kLeastSpread);
  const auto value = [scale](float x) { return std::clamp(x * scale, -4.0F, 4.0F); };
  for (int j = 0; j < F::kFootRows; ++j) {
    *out++ = value(left[j] - middle[j]);
    *out++ = value(middle[j] - core);
    *out++ = value(right[j] - middle[j]);
  }
}

void FeatureReader::read(const Bands& bands, const PanoramaView& panorama, const TrunkShape& shape,
                         const EdgeFit& fit, int first_band, F::Values& out) const {
  RowLevels levels;
  const float spread = read_but_foot(bands, shape, fit, first_band, Care::full, levels, out);
  even_rows(levels, out.data());
  float* const foot = out.data() + F::kGrid;
  read_foot(bands, panorama, shape, spread, foot);
  out.back() = even_foot(std::max(spread, Bands::kLeastSpread), foot);
}

void FeatureReader::glance(const Bands& bands, const TrunkShape& shape, const EdgeFit& fit,
                           int first_band, F::Values& out) const {
  RowLevels levels;
  read_but_foot(bands, shape, fit, first_band, Care::glance, levels, out);
}

float FeatureReader::read_but_foot(const Bands& bands, const TrunkShape& shape, const EdgeFit& fit,
                                   int first_band, Care care, RowLevels& levels,
                                   F::Values& out) const {
  static_assert(F::kHeights == kGridHeights && F::kAcross == kGridAcross);
  static_assert(Bands::kSpare >= kGridLookahead);
  const float spread = read_grid(bands, shape, first_band, care, out.data());
  const auto f = static_cast<float>(focal_);
  const float w = shape.width();
  const float top = static_cast<float>(first_band * Bands::kRows);
  const float numbers[F::kNumbers] = {
      std::log(w * kReferenceFocal / (20 * f)),
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
  std::copy(std::begin(numbers), std::end(numbers), out.data() + F::kGrid + F::kFoot);
  levels = row_contrasts(std::max(spread, Bands::kLeastSpread), out.data(),
                         out.data() + F::kGrid + F::kFoot + F::kNumbers);
  return spread;
}

}  // namespace bole
