#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "detect/contrast/edge_kernels.h"
#include "detect/rounding.h"

namespace bole {
namespace {

// The sum of kEdgeLanes numbers, in halves.
float sum_of(float* lanes) {
  for (int half = kEdgeLanes / 2; half > 0; half /= 2)
    for (int i = 0; i < half; ++i) lanes[i] += lanes[i + half];
  return lanes[0];
}

float row_of(const EdgeBands& bands, int band) {
  return bands.first_row + bands.row_step * static_cast<float>(band);
}

int nearest_column(const EdgeBands& bands, EdgeLine line, int band) {
  return static_cast<int>(row_of(bands, band) * line.slope + (line.column + (kFar + 0.5F))) -
         static_cast<int>(kFar);
}

}  // namespace

void place_edge_plain(const EdgeBands& bands, EdgeLine line, int sign, int least, float strongest,
                      EdgePlaces& places) {
  constexpr int kLast = 2 * EdgePlaces::kReach;
  places = {};
  places.count = EdgePlaces::whole_groups(bands.count);
  for (int band = 0; band < bands.count; ++band) {
    places.row[band] = row_of(bands, band);
    const int first = nearest_column(bands, line, band) - EdgePlaces::kReach;
    int r[kLast + 1], peak = 0;
    for (int o = 0; o <= kLast; ++o) {
      const int bend = bands.bend(band, first + o);
      r[o] = band < bands.horizon ? std::abs(bend) : sign * bend;
      if (r[o] > r[peak]) peak = o;
    }
    if (r[peak] < least || peak == 0 || peak == kLast) continue;
    const int bend = r[peak - 1] - 2 * r[peak] + r[peak + 1];
    const float shift =
        bend < 0 ? 0.5F * static_cast<float>(r[peak - 1] - r[peak + 1]) / static_cast<float>(bend)
                 : 0;
    places.column[band] = static_cast<float>(first + peak) + std::clamp(shift, -0.5F, 0.5F);
    places.weight[band] =
        std::min(static_cast<float>(r[peak]) * (1 / static_cast<float>(bands.flank)), strongest);
    ++places.found;
  }
}

LineSums sum_places_plain(const EdgePlaces& places, EdgeLine line, float tail) {
  float sums[6][kEdgeLanes] = {};
  for (int i = 0; i < places.count; ++i) {
    const float row = places.row[i];
    const float error = places.column[i] - (line.column + line.slope * row);
    const float u = error * (1 / tail);
    const float rest = std::max(0.0F, 1 - u * u);
    const float w = places.weight[i] * (rest * rest);
    const float terms[6] = {w,         w * row,         w * row * row,
                            w * error, w * row * error, w * error * error};
    for (int k = 0; k < 6; ++k) sums[k][i % kEdgeLanes] += terms[k];
  }
  return {sum_of(sums[0]), sum_of(sums[1]), sum_of(sums[2]),
          sum_of(sums[3]), sum_of(sums[4]), sum_of(sums[5])};
}

EdgeResponses respond_along_plain(const EdgeBands& bands, EdgeLine left, EdgeLine right,
                                  float full) {
  EdgeResponses result;
  float below[2][kEdgeLanes] = {}, above[2][kEdgeLanes] = {};
  for (int band = 0; band < bands.count; ++band) {
    const auto response = [&](EdgeLine line, float factor) {
      const int bend = bands.bend(band, nearest_column(bands, line, band));
      return std::clamp(static_cast<float>(bend) * factor, -1.0F, 1.0F);
    };
    const float r[2] = {response(left, -(1 / full)), response(right, 1 / full)};
    const bool is_above = band < bands.horizon;
    for (int e = 0; e < 2; ++e)
      (is_above ? above : below)[e][band % kEdgeLanes] += is_above ? std::abs(r[e]) : r[e];
    if (is_above) {
      result.agree_above += std::min(std::abs(r[0]), std::abs(r[1])) > 0.3F;
    } else {
      result.agree_below += std::min(r[0], r[1]) > 0.25F;
    }
  }
  result.below = {sum_of(below[0]), sum_of(below[1])};
  result.above = {sum_of(above[0]), sum_of(above[1])};
  return result;
}

void join_edges_plain(const EdgeBands& bands, EdgeLine left, EdgeLine right, float full,
                      BandValues& values) {
  for (int band = 0; band < bands.count; ++band) {
    const bool above = band < bands.horizon;
    const auto response = [&](EdgeLine line, float factor) {
      const int bend = bands.bend(band, nearest_column(bands, line, band));
      const float value = std::clamp(static_cast<float>(bend) * factor, -1.0F, 1.0F);
      return above ? std::max(value, kWrongSignAbove * value) : value;
    };
    const float l = response(left, -(1 / full)), r = response(right, 1 / full);
    const float both = 0.25F * (l + r) + 0.5F * std::min(l, r);
    values[band] = above ? 0.4F * (both - 0.5F) : both - 0.3F;
  }
}

}  // namespace bole
