#include "detect/paper/column_sums.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detect/paper/column_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR
// For each column: P2 goes on from `p2_in` to `p2_out` (which may be the same) and p1 is brought
// up to date, over `count` rows. Few enough rows that the sums over them fit 16 bits, which adds
// twice as many columns at a time; the 32-bit sums are touched once.
template <class D16>
void AccumulateColumns(D16 d16, int width, const std::uint8_t* pixels, int stride, int count,
                       std::uint32_t* HWY_RESTRICT p1, const std::uint32_t* p2_in,
                       std::uint32_t* p2_out) {
  const hn::Rebind<std::uint8_t, D16> d8;
  const hn::Repartition<std::uint32_t, D16> d32;
  const int lanes = static_cast<int>(hn::Lanes(d16));
  const int lanes32 = static_cast<int>(hn::Lanes(d32));
  const auto rows = hn::Set(d32, static_cast<std::uint32_t>(count));
  const auto add_to_wide = [&](int j, auto sum, auto sum_of_sums) {
    const auto before = hn::LoadU(d32, p1 + j);
    const auto p2 = hn::LoadU(d32, p2_in + j);
    hn::StoreU(hn::Add(before, sum), d32, p1 + j);
    hn::StoreU(hn::Add(hn::Add(p2, hn::Mul(rows, before)), sum_of_sums), d32, p2_out + j);
  };
  const hn::Half<D16> half16;
  for (int j = 0; j < width; j += lanes) {
    auto sum = hn::Zero(d16);
    auto sum_of_sums = hn::Zero(d16);
    const std::uint8_t* pixel = pixels + j;
    for (int i = 0; i < count; ++i, pixel += stride) {
      sum = hn::Add(sum, hn::PromoteTo(d16, hn::LoadU(d8, pixel)));
      sum_of_sums = hn::Add(sum_of_sums, sum);
    }
    add_to_wide(j, hn::PromoteTo(d32, hn::LowerHalf(half16, sum)),
                hn::PromoteTo(d32, hn::LowerHalf(half16, sum_of_sums)));
    add_to_wide(j + lanes32, hn::PromoteTo(d32, hn::UpperHalf(half16, sum)),
                hn::PromoteTo(d32, hn::UpperHalf(half16, sum_of_sums)));
  }
}

#endif

void Accumulate(int width, const std::uint8_t* pixels, int stride, int count, std::uint32_t* p1,
                const std::uint32_t* p2_in, std::uint32_t* p2_out) {
  int whole = 0;
#if HWY_TARGET != HWY_SCALAR
  const hn::ScalableTag<std::uint16_t> d16;
  whole = width - width % static_cast<int>(hn::Lanes(d16));
  AccumulateColumns(d16, whole, pixels, stride, count, p1, p2_in, p2_out);
#endif
  for (int j = whole; j < width; ++j) {
    std::uint32_t p2 = p2_in[j];
    for (int i = 0; i < count; ++i) {
      p1[j] += pixels[static_cast<std::ptrdiff_t>(i) * stride + j];
      p2 += p1[j];
    }
    p2_out[j] = p2;
  }
}

}  // namespace bole::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bole {
namespace {

HWY_EXPORT(Accumulate);

// 255 n (n + 1) / 2 < 2^16.
constexpr int kMostRowsAtOnce = 16;

// Columns that may be read behind the last, so that loops can run over whole vectors: one of the
// widest there are, 256 bytes.
constexpr int kSpare = 256 / sizeof(std::uint32_t);

}  // namespace

ColumnSums::ColumnSums(int width, int rows, std::vector<int> kept)
    : width_(width), rows_(rows), kept_(std::move(kept)) {
  kept_.push_back(-1);  // all zero: where P2 begins
  kept_.push_back(rows - 1);
  std::sort(kept_.begin(), kept_.end());
  kept_.erase(std::unique(kept_.begin(), kept_.end()), kept_.end());
  first_row_.resize(width_ + kSpare);
  last_row_.resize(width_);
  p1_.resize(width_);
  p2_.resize(kept_.size() * static_cast<std::size_t>(width_) + kSpare);
}

void ColumnSums::begin() {
  std::fill(p1_.begin(), p1_.end(), 0);
  row_ = 0;
  slot_ = 1;
  slot_begun_ = false;
}

void ColumnSums::add_rows(const std::uint8_t* pixels, int stride, int count) {
  if (row_ == 0) std::copy_n(pixels, width_, first_row_.begin());
  while (count > 0) {
    const int n = std::min({count, kept_[slot_] - row_ + 1, kMostRowsAtOnce});
    HWY_DYNAMIC_DISPATCH(Accumulate)
    (width_, pixels, stride, n, p1_.data(), kept_row(slot_begun_ ? slot_ : slot_ - 1),
     kept_row(slot_));
    row_ += n;
    count -= n;
    pixels += static_cast<std::ptrdiff_t>(n) * stride;
    slot_begun_ = row_ <= kept_[slot_];
    if (!slot_begun_) ++slot_;
  }
  if (row_ == rows_) std::copy_n(pixels - stride, width_, last_row_.begin());
}

void ColumnSums::end() {
  const std::uint32_t* p2 = kept_row(slot_ - 1);
  for (; slot_ < kept_.size(); ++slot_) {
    const auto below = static_cast<std::uint32_t>(kept_[slot_] - rows_ + 1);
    const std::uint32_t triangle = below * (below + 1) / 2;
    std::uint32_t* out = kept_row(slot_);
    for (int j = 0; j < width_; ++j) out[j] = p2[j] + below * p1_[j] + triangle * last_row_[j];
  }
}

std::span<const std::uint32_t> ColumnSums::kept(int row) const {
  const auto slot = std::lower_bound(kept_.begin(), kept_.end(), row) - kept_.begin();
  return {p2_.data() + slot * static_cast<std::ptrdiff_t>(width_),
          static_cast<std::size_t>(width_)};
}

}  // namespace bole
#endif
