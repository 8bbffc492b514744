#include "detect/paper/paper_scores.h"

#include <algorithm>
#include <limits>

#include "base/errors.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detect/paper/paper_scores.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// out = bottom - top - above + times first_row, modulo 2^32. Runs over whole vectors.
void WeightRows(const std::uint32_t* HWY_RESTRICT bottom, const std::uint32_t* HWY_RESTRICT top,
                const std::uint32_t* HWY_RESTRICT above,
                const std::uint32_t* HWY_RESTRICT first_row, std::uint32_t times, int width,
                float* HWY_RESTRICT out) {
  const hn::ScalableTag<float> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const hn::RebindToSigned<decltype(d)> di;
  const auto factor = hn::Set(du, times);
  for (int j = 0; j < width; j += static_cast<int>(hn::Lanes(d))) {
    const auto gone = hn::Add(hn::LoadU(du, top + j), hn::LoadU(du, above + j));
    const auto there =
        hn::Add(hn::Mul(factor, hn::LoadU(du, first_row + j)), hn::LoadU(du, bottom + j));
    hn::StoreU(hn::ConvertTo(d, hn::BitCast(di, hn::Sub(there, gone))), d, out + j);
  }
}

// Vectors of columns that are filtered together; loops run over whole blocks, into the margin.
constexpr int kBlock = 4;

// out = sum over x from 0 to reach of profile[x] (in[. - x] + in[. + x]).
//
// Offsets that are a whole number of vectors apart use the same vectors of the input for
// neighbouring columns: taken one after the other, they need one new vector on each side in place
// of four.
void FilterRow(const float* HWY_RESTRICT in, int width, const float* HWY_RESTRICT profile,
               int reach, float* HWY_RESTRICT out) {
  const hn::ScalableTag<float> d;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  for (std::ptrdiff_t j = 0; j < width; j += kBlock * lanes) {
    auto a = hn::Zero(d), b = hn::Zero(d), c = hn::Zero(d), e = hn::Zero(d);
    for (std::ptrdiff_t first = 0; first < lanes && first <= reach; ++first) {
      const float* left = in + j - first;
      const float* right = in + j + first;
      auto left_a = hn::LoadU(d, left), left_b = hn::LoadU(d, left + lanes);
      auto left_c = hn::LoadU(d, left + 2 * lanes), left_e = hn::LoadU(d, left + 3 * lanes);
      auto right_a = hn::LoadU(d, right), right_b = hn::LoadU(d, right + lanes);
      auto right_c = hn::LoadU(d, right + 2 * lanes), right_e = hn::LoadU(d, right + 3 * lanes);
      for (std::ptrdiff_t x = first;;) {
        const auto weight = hn::Set(d, profile[x]);
        a = hn::MulAdd(weight, hn::Add(left_a, right_a), a);
        b = hn::MulAdd(weight, hn::Add(left_b, right_b), b);
        c = hn::MulAdd(weight, hn::Add(left_c, right_c), c);
        e = hn::MulAdd(weight, hn::Add(left_e, right_e), e);
        x += lanes;
        if (x > reach) break;
        left_e = left_c, left_c = left_b, left_b = left_a, left_a = hn::LoadU(d, in + j - x);
        right_a = right_b, right_b = right_c, right_c = right_e;
        right_e = hn::LoadU(d, in + j + x + 3 * lanes);
      }
    }
    hn::StoreU(a, d, out + j);
    hn::StoreU(b, d, out + j + lanes);
    hn::StoreU(c, d, out + j + 2 * lanes);
    hn::StoreU(e, d, out + j + 3 * lanes);
  }
}

}  // namespace bole::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bole {
namespace {

HWY_EXPORT(WeightRows);
HWY_EXPORT(FilterRow);

// A block of the widest vectors there are, 256 bytes each.
constexpr std::size_t kSpare = std::size_t{4} * 256 / sizeof(float);

// P2(row) of rows above the image, as a multiple of the first row.
std::uint32_t first_rows_above(int row) {
  const auto k = static_cast<std::uint32_t>(std::max(-2 - row, 0));
  return k * (k + 1) / 2;
}

int largest_reach(const std::vector<PaperTemplate>& templates) {
  int reach = 0;
  for (const PaperTemplate& t : templates) reach = std::max(reach, t.reach());
  return reach;
}

// The bar's profile over s^2 n a, its middle halved: FilterRow counts it on both sides.
std::vector<float> profile_of(const PaperTemplate& t) {
  const double n = t.foot_row + 1;
  const double scale = 1 / (t.width_px * t.width_px * n * t.foot_distance);
  std::vector<float> profile;
  for (const float value : t.bar) profile.push_back(static_cast<float>(value * scale));
  profile[0] /= 2;
  return profile;
}

void check_sums_fit(const PaperTemplate& t) {
  const double largest = 255.0 * (t.foot_row + 1) * (2 * t.reach() + 1);
  if (largest > std::numeric_limits<std::int32_t>::max()) {
    throw ConfigError("camera.toml", "panorama.columns", "makes templates too large to sum",
                      "fewer columns, or a smaller diameter_m");
  }
}

}  // namespace

PaperScores::Reads PaperScores::reads_of(const PaperTemplate& t) {
  const int m = t.reach();
  const int above = t.foot_row - m - 1;
  return {t.foot_row + m, m - 1, std::max(above, -1),
          first_rows_above(-m - 2) - first_rows_above(above)};
}

std::vector<int> PaperScores::rows_read(const std::vector<PaperTemplate>& templates) {
  std::vector<int> rows;
  for (const PaperTemplate& t : templates) {
    check_sums_fit(t);
    const Reads r = reads_of(t);
    rows.insert(rows.end(), {r.bottom, r.top, r.above});
  }
  return rows;
}

PaperScores::PaperScores(const PanoramaGeometry& panorama, std::vector<PaperTemplate> templates)
    : templates_(std::move(templates)),
      width_(panorama.width),
      wraps_(panorama.wraps()),
      margin_(largest_reach(templates_)),
      sums_(panorama.width, panorama.rows, rows_read(templates_)),
      weighted_(width_ + 2 * margin_ + kSpare),
      scores_(width_ + kSpare) {
  for (const PaperTemplate& t : templates_) profiles_.push_back(profile_of(t));
}

void PaperScores::continue_to_the_sides(int reach) {
  float* first = weighted_.data() + margin_;
  float* end = first + width_;
  if (wraps_) {
    std::copy(end - reach, end, first - reach);
    std::copy(first, first + reach, end);
  } else {
    std::fill(first - reach, first, *first);
    std::fill(end, end + reach, end[-1]);
  }
}

std::span<const float> PaperScores::scores(std::size_t k) {
  const PaperTemplate& t = templates_[k];
  const Reads reads = reads_of(t);
  const std::uint32_t* bottom = sums_.kept(reads.bottom).data();
  const std::uint32_t* top = sums_.kept(reads.top).data();
  const std::uint32_t* above = sums_.kept(reads.above).data();
  const std::uint32_t* first_row = sums_.first_row().data();
  float* weighted = weighted_.data() + margin_;
  HWY_DYNAMIC_DISPATCH(WeightRows)
  (bottom, top, above, first_row, reads.first_row_times, width_, weighted);
  continue_to_the_sides(t.reach());
  HWY_DYNAMIC_DISPATCH(FilterRow)
  (weighted, width_, profiles_[k].data(), t.reach(), scores_.data());
  return {scores_.data(), static_cast<std::size_t>(width_)};
}

}  // namespace bole
#endif
