#include "detect/contrast/trunk_shape.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "detect/contrast/edge_search.h"
#include "detect/rounding.h"

namespace bole {
namespace {

constexpr float kContrast = 0.22F * Bands::kScale;
constexpr float kStrongContrast = 1.2F * Bands::kScale;
constexpr float kLeastSum = 1.0F;    // of the contrast above another foot, in full bands
constexpr float kFootReach = 6;      // rows: the network finds a foot that is this near
constexpr float kMostTaper = 0.05F;  // difference of the edges' slopes
constexpr int kLevelFeet = 3;
constexpr float kFall = 0.4F;  // by how much it falls below it

// To the nearest whole number; columns and rows stay far from the limits.
int nearest(float x) { return static_cast<int>(x + (kFar + 0.5F)) - static_cast<int>(kFar); }

// The line along which an edge of contrast `sign` stands out most, at most `reach` columns from
// `column` at the foot, so many bands below the first one.
EdgeLine search(const EdgeBands& bands, int foot, float column, int reach, int sign) {
  constexpr int kMiddlePlace = EdgeSearch::kPlaces / 2, kUpright = EdgeSearch::kSlopes / 2;
  constexpr float kSlopeStep = EdgeSearch::kSlopeStep / 1000.0F;  // columns a row
  const int middle = nearest(column);
  const FoundEdge found = find_edge(bands, {.first_column = middle - EdgeSearch::kColumns / 2,
                                            .reach = reach,
                                            .foot = foot,
                                            .sign = sign,
                                            .limit = static_cast<int>(kContrast)});
  return {static_cast<float>(middle + found.place - kMiddlePlace),
          kSlopeStep * static_cast<float>(found.slope - kUpright)};
}

// Moves a line by least squares, from the sums of places about it; false where they do not tell.
bool improve(const LineSums& s, float searched_slope, EdgeLine& line) {
  if (s.w <= 0) return false;
  // A weak pull towards the searched slope keeps short trunks from tilting.
  const double w = s.w, pull = w * 40;
  const double det = w * (s.row_row + pull) - double{s.row} * s.row;
  if (det <= 0) return false;
  const double turn =
      (w * (s.row_error + pull * (searched_slope - line.slope)) - double{s.row} * s.error) / det;
  line.column += static_cast<float>((s.error - turn * s.row) / w);
  line.slope += static_cast<float>(turn);
  return true;
}

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

float foot_unit(const TrunkShape& shape, double focal) {
  const float scale = static_cast<float>(focal) / kReferenceFocal;
  return std::clamp(0.12F * shape.width(), 0.8F * scale, 5.0F * scale);
}

EdgeFitter::EdgeFitter(const DetectorSetup& setup)
    : width_(setup.panorama.width),
      horizon_band_(
          static_cast<int>(std::lround((setup.panorama.horizon_row() + 0.5) / Bands::kRows))),
      horizon_(static_cast<float>(setup.panorama.horizon_row() + 0.5)),
      farthest_foot_(static_cast<float>(setup.height * setup.panorama.focal() /
                                        (1.1 * setup.search.range.high))),
      level_foot_{setup.height / setup.search.diameter.high,
                  setup.height / setup.search.diameter.low},
      margin_(Templates::margin(setup)) {
  for (int x = -margin_; x < width_ + margin_; ++x) {
    const SeenRows& seen = setup.seen.columns[column_within(x, width_, setup.panorama.wraps())];
    first_seen_.push_back((seen.first + Bands::kRows - 1) / Bands::kRows);
    last_seen_.push_back(seen.empty() ? setup.panorama.rows : seen.last);
  }
}

int EdgeFitter::first_band(float left, float right) const {
  const auto at = [&](float x) {
    return std::clamp(static_cast<int>(x) + margin_, 0, width_ + 2 * margin_ - 1);
  };
  const int from = at(std::floor(left)), to = at(std::ceil(right));
  const int step = std::max(1, (to - from) / 16);
  int first = 0;
  for (int x = from; x <= to; x += step) first = std::max(first, first_seen_[x]);
  return first;
}

float EdgeFitter::last_row(float column) const {
  const int at = static_cast<int>(std::floor(column)) + margin_;
  return static_cast<float>(last_seen_[std::clamp(at, 0, width_ + 2 * margin_ - 1)]);
}

EdgeBands EdgeFitter::along(const Bands& bands, Extent extent, float foot, int flank) const {
  return {.sums = bands.sum(extent.first),
          .pitch = bands.pitch(),
          .count = extent.count(),
          .horizon = horizon_band_ - extent.first,
          .first_row = row_of(extent.first) - foot,
          .row_step = Bands::kRows,
          .flank = flank};
}

// Both edges, step by step side by side: neither has to wait for the other's divisions.
std::array<float, 2> EdgeFitter::place(const EdgeBands& bands, std::array<EdgeLine, 2>& lines,
                                       int sign) const {
  const int least = nearest(0.15F * kContrast * static_cast<float>(bands.flank));
  std::array<EdgePlaces, 2> places;
  for (const int e : {0, 1})
    place_edge(bands, lines[e], e == 0 ? -sign : sign, least, kStrongContrast, places[e]);
  std::array<EdgeLine, 2> fitted = lines;
  std::array<float, 2> scatter = {1, 1};
  std::array<bool, 2> fits = {places[0].found >= 4, places[1].found >= 4};
  for (int round = 0; round < 3; ++round) {
    for (const int e : {0, 1}) {
      if (!fits[e]) continue;
      const float limit = round == 0 ? 2.0F : std::max(0.4F, 1.5F * scatter[e]);
      const LineSums sums = sum_places(places[e], fitted[e], 2.5F * limit);
      fits[e] = improve(sums, lines[e].slope, fitted[e]);
      if (fits[e]) scatter[e] = std::sqrt(sums.error_error / sums.w);
    }
  }
  for (const int e : {0, 1}) {
    if (places[e].found < 4) {
      scatter[e] = 3;
    } else if (std::abs(fitted[e].slope) < kMostLean &&
               std::abs(fitted[e].column - lines[e].column) < 6) {
      lines[e] = fitted[e];
    }
  }
  return scatter;
}

void EdgeFitter::judge(const EdgeBands& bands, const TrunkShape& shape, EdgeFit& fit) const {
  const float full = (shape.dark ? kContrast : -kContrast) * static_cast<float>(bands.flank);
  const EdgeResponses r =
      respond_along(bands, {shape.left, shape.left_slope}, {shape.right, shape.right_slope}, full);
  const int above = std::clamp(bands.horizon, 0, bands.count);
  const auto share = [](auto value, int n) {
    return n > 0 ? static_cast<float>(value) / static_cast<float>(n) : 0.0F;
  };
  fit.contrast_left = share(r.below[0], bands.count - above);
  fit.contrast_right = share(r.below[1], bands.count - above);
  fit.above_left = share(r.above[0], above);
  fit.above_right = share(r.above[1], above);
  fit.agreement = share(r.agree_below, bands.count - above);
  fit.agreement_above = share(r.agree_above, above);
}

EdgeFitter::Extent EdgeFitter::extent(const Bands& bands, float left, float width,
                                      float foot) const {
  const float flare = std::min(0.5F * width, 0.3F * foot);
  Extent extent;
  extent.last = std::clamp(static_cast<int>((foot - flare) / Bands::kRows), 0, bands.count());
  extent.first = std::max(first_band(left, left + width), extent.last - kMostEdgeBands);
  return extent;
}

bool EdgeFitter::fit(const Bands& bands, const Candidate& c, TrunkShape& shape,
                     EdgeFit& fit) const {
  const Extent straight = extent(bands, c.left, c.width, c.foot);
  if (straight.count() < 3) return false;
  const int flank = std::clamp(static_cast<int>(0.3F * c.width), 2, 8);
  const int reach = std::min(10, static_cast<int>(1 + 0.05F * c.width));
  const int sign = c.dark ? 1 : -1;
  const EdgeBands edges = along(bands, straight, c.foot, flank);
  const int foot = nearest(c.foot / Bands::kRows) - straight.first;
  EdgeLine left = search(edges, foot, c.left, reach, -sign);
  EdgeLine right = search(edges, foot, c.left + c.width, reach, sign);
  if (right.column - left.column < 2.5F) return false;
  if (std::abs(left.slope - right.slope) > kMostTaper) {
    // One has gone astray, and more trunks stand upright than lean.
    left.slope = right.slope =
        std::abs(left.slope) < std::abs(right.slope) ? left.slope : right.slope;
  }
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
  const float full = (shape.dark ? kContrast : -kContrast) * static_cast<float>(flank);
  struct Peak {
    int band = 0;
    float sum = 0;
  };
  std::array<Peak, kFeetByContrast> peaks;
  const auto offer = [&](Peak peak) {
    const float row = static_cast<float>(peak.band + 1) * Bands::kRows;
    if (std::abs(row - shape.foot) < std::max(8.0F, 0.35F * shape.width())) return;
    for (Peak& kept : peaks)
      if (peak.sum > kept.sum) std::swap(peak, kept);
  };
  Peak running;
  float sum = 0;
  const int lowest = std::min(bands.count(), static_cast<int>(shape.foot) / Bands::kRows + 30);
  BandValues values;
  for (int first = first_band(shape.left, shape.right); first < lowest; first += kMostEdgeBands) {
    const EdgeBands edges =
        along(bands, {first, std::min(lowest, first + kMostEdgeBands)}, shape.foot, flank);
    join_edges(edges, {shape.left, shape.left_slope}, {shape.right, shape.right_slope}, full,
               values);
    for (int i = 0; i < edges.count; ++i) {
      sum = std::max(sum + values[i], 0.0F);
      if (sum > running.sum) running = {first + i, sum};
      if (running.sum > kLeastSum && sum < running.sum - kFall) {
        offer(running);
        running = {first + i, sum};
      }
    }
  }
  if (running.sum > kLeastSum) offer(running);
  int count = 0;
  for (const Peak& peak : peaks)
    if (peak.sum > 0) feet[count++] = static_cast<float>((peak.band + 1) * Bands::kRows);
  return add_level_feet(shape, feet, count);
}

int EdgeFitter::add_level_feet(const TrunkShape& shape, std::array<float, kOtherFeet>& feet,
                               int count) const {
  const int others = count;
  const float width = shape.width();
  const float high = std::max(static_cast<float>(level_foot_.low) * width, farthest_foot_);
  const float low = static_cast<float>(level_foot_.high) * width;
  const float reach = std::max({kFootReach, 0.6F * width, (low - high) / (2 * kLevelFeet)});
  const float last = last_row(shape.centre());
  const auto offer = [&](float row) {
    const auto near = [&](float other) { return std::abs(row - other) < reach; };
    if (count < kOtherFeet && !near(shape.foot) &&
        std::none_of(feet.begin(), feet.begin() + others, near))
      feet[count++] = row;
  };
  if (horizon_ + low > last) offer(last);
  for (int i = 0; i < kLevelFeet; ++i) {
    const float row = horizon_ + high + static_cast<float>(2 * i + 1) * reach;
    if (row < std::min(horizon_ + low, last)) offer(row);
  }
  return count;
}

void EdgeFitter::refine(const Bands& bands, TrunkShape& shape, EdgeFit& fit) const {
  const Extent straight = extent(bands, shape.left, shape.width(), shape.foot);
  const EdgeBands edges =
      along(bands, straight, shape.foot, std::clamp(static_cast<int>(0.2F * shape.width()), 2, 5));
  const int sign = shape.dark ? 1 : -1;
  std::array<EdgeLine, 2> lines = {
      {{shape.left, shape.left_slope}, {shape.right, shape.right_slope}}};
  const std::array<float, 2> scatter = place(edges, lines, sign);
  fit.scatter_left = scatter[0];
  fit.scatter_right = scatter[1];
  const auto& [left, right] = lines;
  if (right.column - left.column > 2.5F) {
    shape.left = left.column;
    shape.left_slope = left.slope;
    shape.right = right.column;
    shape.right_slope = right.slope;
  }
  const int flank = std::clamp(static_cast<int>(0.25F * shape.width()), 2, 6);
  judge(along(bands, straight, shape.foot, flank), shape, fit);
}

}  // namespace bole
