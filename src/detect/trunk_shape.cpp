#include "detect/trunk_shape.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace bole {
namespace {

constexpr float kSlopeStep = 0.015F;  // columns a row
constexpr float kContrast = 0.22F * Bands::kScale;
constexpr float kStrongContrast = 1.2F * Bands::kScale;
constexpr float kLeastSum = 1.0F;    // of the contrast above another foot, in full bands
constexpr float kFall = 0.6F;        // by how much it falls below it
constexpr float kWrongSign = -0.7F;  // what a response of the wrong sign counts above the horizon

float response(const std::int32_t* sum, int x, int k) {
  return static_cast<float>(sum[x + k] - 2 * sum[x] + sum[x - k]) / static_cast<float>(k);
}

// To the nearest whole number; columns and rows stay far from the limits.
int nearest(float x) { return static_cast<int>(x + 16384.5F) - 16384; }

float slope_of(int s) { return kSlopeStep * static_cast<float>(s - EdgeWindow::kSlopes / 2); }

float row_of(int band) { return (static_cast<float>(band) + 0.5F) * Bands::kRows; }

}  // namespace

TrunkShape ended_at(const TrunkShape& shape, float foot) {
  TrunkShape ended = shape;
  ended.foot = foot;
  ended.left += shape.left_slope * (foot - shape.foot);
  ended.right += shape.right_slope * (foot - shape.foot);
  if (ended.width() < 2.5F) {
    ended.left = ended.centre() - 1.25F;
    ended.right = ended.left + 2.5F;
  }
  return ended;
}

EdgeFitter::EdgeFitter(const DetectorSetup& setup)
    : width_(setup.panorama.width),
      horizon_band_(
          static_cast<int>(std::lround((setup.panorama.horizon_row() + 0.5) / Bands::kRows))),
      first_seen_(setup.panorama.width),
      wraps_(setup.panorama.wraps()) {
  for (int x = 0; x < width_; ++x)
    first_seen_[x] = (setup.seen.columns[x].first + Bands::kRows - 1) / Bands::kRows;
}

int EdgeFitter::first_band(float left, float right) const {
  int first = 0;
  const int from = static_cast<int>(std::floor(left)), to = static_cast<int>(std::ceil(right));
  const int step = std::max(1, (to - from) / 16);
  for (int x = from; x <= to; x += step) {
    const int column = wraps_ ? ((x % width_) + width_) % width_ : std::clamp(x, 0, width_ - 1);
    first = std::max(first, first_seen_[column]);
  }
  return first;
}

EdgeFitter::Line EdgeFitter::search(const Bands& bands, Line start, const Starts& starts,
                                    Extent extent, int flank, int reach, int sign) const {
  constexpr int kPlaces = EdgeWindow::kPlaces;
  const int origin = nearest(start.column) - EdgeWindow::kColumns / 2;
  EdgeTotals totals;
  sum_edges({.sums = bands.sum(extent.first) + origin,
             .pitch = bands.pitch(),
             .bands = extent.count(),
             .horizon = horizon_band_ - extent.first,
             .flank = flank,
             .sign = sign,
             .limit = static_cast<int>(kContrast),
             .starts = &starts},
            totals);
  float best = -1e9F;
  Line found = start;
  for (int s = 0; s < EdgeWindow::kSlopes; ++s) {
    for (int i = kPlaces / 2 - reach; i <= kPlaces / 2 + reach; ++i) {
      const float value = static_cast<float>(totals[s][i]) *
                          (1 - 0.002F * static_cast<float>(std::abs(i - kPlaces / 2)));
      if (value <= best) continue;
      best = value;
      found = {static_cast<float>(origin + EdgeWindow::kColumns / 2 + i - kPlaces / 2),
               slope_of(s)};
    }
  }
  return found;
}

EdgeFitter::Placed EdgeFitter::place(const Bands& bands, Line& line, float foot, Extent extent,
                                     int flank, int sign) const {
  constexpr int kReach = 3;
  std::array<float, EdgeWindow::kMostBands> rows, places, weights;
  const float scale = 1 / static_cast<float>(flank);
  const int least = nearest(0.15F * kContrast * static_cast<float>(flank));
  int n = 0;
  for (int band = extent.first; band < extent.last; ++band) {
    const float row = row_of(band) - foot;
    const int middle = nearest(line.column + line.slope * row);
    // In whole numbers, `flank` times the response.
    std::array<int, 2 * kReach + 1> r;
    const std::int32_t* sum = bands.sum(band) + middle - kReach;
    int peak = 0;
    for (int o = 0; o <= 2 * kReach; ++o) {
      const int bend = sign * (sum[o + flank] - 2 * sum[o] + sum[o - flank]);
      r[o] = band < horizon_band_ ? std::abs(bend) : bend;
      if (r[o] > r[peak]) peak = o;
    }
    if (r[peak] < least || peak == 0 || peak == 2 * kReach) continue;
    const int bend = r[peak - 1] - 2 * r[peak] + r[peak + 1];
    const float shift =
        bend < 0 ? 0.5F * static_cast<float>(r[peak - 1] - r[peak + 1]) / static_cast<float>(bend)
                 : 0;
    rows[n] = row;
    places[n] = static_cast<float>(middle + peak - kReach) + std::clamp(shift, -0.5F, 0.5F);
    weights[n] = std::min(static_cast<float>(r[peak]) * scale, kStrongContrast);
    ++n;
  }
  if (n < 4) return {3, 1};
  // Straight line by least squares; places far off it count less and less.
  Line fitted = line;
  float scatter = 1, slope_variance = 1;
  for (int round = 0; round < 3; ++round) {
    const float limit = round == 0 ? 2.0F : std::max(0.4F, 1.5F * scatter);
    double s = 0, sr = 0, srr = 0, sp = 0, srp = 0, se = 0;
    for (int i = 0; i < n; ++i) {
      const float error = places[i] - fitted.column - fitted.slope * rows[i];
      const float u = error / (2.5F * limit);
      const float tail = u * u < 1 ? (1 - u * u) * (1 - u * u) : 0;
      const double w = weights[i] * tail;
      s += w;
      sr += w * rows[i];
      srr += w * rows[i] * rows[i];
      sp += w * places[i];
      srp += w * rows[i] * places[i];
      se += w * error * error;
    }
    if (s <= 0) break;
    // A weak pull towards the searched slope keeps short trunks from tilting.
    const double pull = s * 40;
    const double det = s * (srr + pull) - sr * sr;
    if (det <= 0) break;
    const double slope = (s * (srp + pull * line.slope) - sr * sp) / det;
    fitted = {static_cast<float>((sp - slope * sr) / s), static_cast<float>(slope)};
    scatter = static_cast<float>(std::sqrt(se / s));
    slope_variance = static_cast<float>(std::max(0.04, se / s) * s / det * s / std::max(4, n));
  }
  if (std::abs(fitted.slope) < 0.12F && std::abs(fitted.column - line.column) < 6) line = fitted;
  return {scatter, slope_variance};
}

void EdgeFitter::judge(const Bands& bands, const TrunkShape& shape, Extent extent,
                       EdgeFit& fit) const {
  const int flank = std::clamp(static_cast<int>(0.25F * shape.width()), 2, 6);
  const float sign = shape.dark ? 1.0F : -1.0F;
  std::array<float, 2> sum{}, above{};
  int below_count = 0, above_count = 0, agree = 0, agree_above = 0;
  for (int band = extent.first; band < extent.last; ++band) {
    const float row = row_of(band) - shape.foot;
    const float places[2] = {shape.left + shape.left_slope * row,
                             shape.right + shape.right_slope * row};
    float r[2];
    for (int e = 0; e < 2; ++e) {
      const float value = response(bands.sum(band), nearest(places[e]), flank);
      r[e] = std::clamp((e == 0 ? -sign : sign) * value / kContrast, -1.0F, 1.0F);
    }
    if (band < horizon_band_) {
      ++above_count;
      for (int e = 0; e < 2; ++e) above[e] += std::abs(r[e]);
      agree_above += std::min(std::abs(r[0]), std::abs(r[1])) > 0.3F;
    } else {
      ++below_count;
      for (int e = 0; e < 2; ++e) sum[e] += r[e];
      agree += std::min(r[0], r[1]) > 0.25F;
    }
  }
  const auto share = [](auto value, int n) {
    return n > 0 ? static_cast<float>(value) / static_cast<float>(n) : 0.0F;
  };
  fit.contrast_left = share(sum[0], below_count);
  fit.contrast_right = share(sum[1], below_count);
  fit.above_left = share(above[0], above_count);
  fit.above_right = share(above[1], above_count);
  fit.agreement = share(agree, below_count);
  fit.agreement_above = share(agree_above, above_count);
  fit.bands = extent.count();
}

EdgeFitter::Extent EdgeFitter::extent(const Bands& bands, float left, float width,
                                      float foot) const {
  const float flare = std::min(0.5F * width, 0.3F * foot);
  Extent extent;
  extent.last = std::clamp(static_cast<int>((foot - flare) / Bands::kRows), 0, bands.count());
  extent.first = std::max(first_band(left, left + width), extent.last - EdgeWindow::kMostBands);
  return extent;
}

bool EdgeFitter::fit(const Bands& bands, const Candidate& c, TrunkShape& shape,
                     EdgeFit& fit) const {
  const Extent straight = extent(bands, c.left, c.width, c.foot);
  if (straight.count() < 3) return false;
  const int flank = std::clamp(static_cast<int>(0.3F * c.width), 2, 8);
  const int reach = std::min(10, static_cast<int>(2 + 0.2F * c.width));
  const int sign = c.dark ? 1 : -1;
  Starts starts;
  for (int band = straight.first; band < straight.last; ++band) {
    for (int s = 0; s < EdgeWindow::kSlopes; ++s) {
      const int shift = nearest(slope_of(s) * (row_of(band) - c.foot));
      constexpr int kMiddle = (EdgeWindow::kColumns - EdgeWindow::kPlaces) / 2;
      starts[band - straight.first][s] =
          static_cast<std::uint8_t>(std::clamp(kMiddle + shift, 0, 2 * kMiddle));
    }
  }
  const Line left = search(bands, {c.left, 0}, starts, straight, flank, reach, -sign);
  const Line right = search(bands, {c.left + c.width, 0}, starts, straight, flank, reach, sign);
  if (right.column - left.column < 2.5F) return false;
  shape = {.foot = c.foot,
           .left = left.column,
           .right = right.column,
           .left_slope = left.slope,
           .right_slope = right.slope,
           .dark = c.dark};
  refine(bands, shape, fit);
  return true;
}

int EdgeFitter::other_feet(const Bands& bands, const TrunkShape& shape,
                           std::array<float, kOtherFeet>& feet) const {
  const int flank = std::clamp(static_cast<int>(0.3F * shape.width()), 2, 8);
  const float sign = (shape.dark ? 1.0F : -1.0F) / kContrast;
  struct Peak {
    int band = 0;
    float sum = 0;
  };
  std::array<Peak, kOtherFeet> peaks;
  const auto offer = [&](Peak peak) {
    const float row = static_cast<float>(peak.band + 1) * Bands::kRows;
    if (std::abs(row - shape.foot) < std::max(8.0F, 0.35F * shape.width())) return;
    for (Peak& kept : peaks)
      if (peak.sum > kept.sum) std::swap(peak, kept);
  };
  Peak running;
  float sum = 0;
  const int lowest = std::min(bands.count(), static_cast<int>(shape.foot) / Bands::kRows + 30);
  for (int band = first_band(shape.left, shape.right); band < lowest; ++band) {
    const float row = row_of(band) - shape.foot;
    const auto at = [&](float column, float slope) {
      const int x = nearest(column + slope * row);
      return std::clamp(sign * response(bands.sum(band), x, flank), -1.0F, 1.0F);
    };
    float l = -at(shape.left, shape.left_slope), r = at(shape.right, shape.right_slope);
    if (band < horizon_band_) {
      l = l < 0 ? kWrongSign * l : l;
      r = r < 0 ? kWrongSign * r : r;
      sum += 0.4F * ((l + r) / 4 + std::min(l, r) / 2 - 0.5F);
    } else {
      sum += (l + r) / 4 + std::min(l, r) / 2 - 0.3F;
    }
    sum = std::max(sum, 0.0F);
    if (sum > running.sum) running = {band, sum};
    if (running.sum > kLeastSum && sum < running.sum - kFall) {
      offer(running);
      running = {band, sum};
    }
  }
  if (running.sum > kLeastSum) offer(running);
  int count = 0;
  for (const Peak& peak : peaks)
    if (peak.sum > 0) feet[count++] = static_cast<float>((peak.band + 1) * Bands::kRows);
  return count;
}

void EdgeFitter::refine(const Bands& bands, TrunkShape& shape, EdgeFit& fit) const {
  const Extent straight = extent(bands, shape.left, shape.width(), shape.foot);
  const int flank = std::clamp(static_cast<int>(0.2F * shape.width()), 2, 5);
  const int sign = shape.dark ? 1 : -1;
  Line left{shape.left, shape.left_slope}, right{shape.right, shape.right_slope};
  const Placed l = place(bands, left, shape.foot, straight, flank, -sign);
  const Placed r = place(bands, right, shape.foot, straight, flank, sign);
  if (right.column - left.column > 2.5F) {
    shape.left = left.column;
    shape.left_slope = left.slope;
    shape.right = right.column;
    shape.right_slope = right.slope;
  }
  fit.scatter_left = l.scatter;
  fit.scatter_right = r.scatter;
  fit.slope_sigma = 0.5F * std::sqrt(l.slope_variance + r.slope_variance);
  judge(bands, shape, straight, fit);
}

}  // namespace bole
