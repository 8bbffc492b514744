#include "detect/edge_kernels.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detect/edge_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void SumEdges(const EdgeWindow& w, EdgeTotals& totals) {
  const hn::CappedTag<std::int32_t, 16> d;
  const hn::RebindToFloat<decltype(d)> df;
  const hn::Rebind<std::int16_t, decltype(d)> d16;
  const hn::CappedTag<std::int16_t, EdgeWindow::kPlaces> dp;
  const int lanes = static_cast<int>(hn::Lanes(d)), places = static_cast<int>(hn::Lanes(dp));
  const auto scale = hn::Set(df, static_cast<float>(w.sign) / static_cast<float>(w.flank));
  const auto limit = hn::Set(df, static_cast<float>(w.limit));
  HWY_ALIGN std::int16_t responses[EdgeWindow::kColumns];
  for (auto& total : totals) total.fill(0);
  const std::int32_t* sums = w.sums;
  for (int band = 0; band < w.bands; ++band, sums += w.pitch) {
    for (int i = 0; i < EdgeWindow::kColumns; i += lanes) {
      const auto middle = hn::LoadU(d, sums + i);
      const auto bend =
          hn::Sub(hn::Add(hn::LoadU(d, sums + i + w.flank), hn::LoadU(d, sums + i - w.flank)),
                  hn::Add(middle, middle));
      const auto response = hn::Mul(hn::ConvertTo(df, bend), scale);
      const auto clipped = hn::Min(limit, hn::Max(hn::Neg(limit), response));
      auto value = hn::DemoteTo(d16, hn::ConvertTo(d, clipped));
      if (band < w.horizon) {
        value = hn::Max(value, hn::ShiftRight<4>(hn::Mul(value, hn::Set(d16, -11))));
      }
      hn::StoreU(value, d16, responses + i);
    }
    const auto& starts = (*w.starts)[band];
    for (int s = 0; s < EdgeWindow::kSlopes; ++s) {
      std::int16_t* total = totals[s].data();
      const std::int16_t* from = responses + starts[s];
      for (int i = 0; i < EdgeWindow::kPlaces; i += places) {
        hn::StoreU(hn::Add(hn::LoadU(dp, total + i), hn::LoadU(dp, from + i)), dp, total + i);
      }
    }
  }
}

}  // namespace bole::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bole {

HWY_EXPORT(SumEdges);

void sum_edges(const EdgeWindow& window, EdgeTotals& totals) {
  HWY_DYNAMIC_DISPATCH(SumEdges)(window, totals);
}

void sum_edges_plain(const EdgeWindow& w, EdgeTotals& totals) {
  const float scale = static_cast<float>(w.sign) / static_cast<float>(w.flank);
  const auto limit = static_cast<float>(w.limit);
  for (auto& total : totals) total.fill(0);
  for (int band = 0; band < w.bands; ++band) {
    const std::int32_t* sums = w.sums + band * w.pitch;
    const auto response = [&](int i) {
      const auto bend = static_cast<float>(sums[i + w.flank] - 2 * sums[i] + sums[i - w.flank]);
      const int value = static_cast<int>(std::clamp(bend * scale, -limit, limit));
      return band < w.horizon ? std::max(value, (-11 * value) >> 4) : value;
    };
    for (int s = 0; s < EdgeWindow::kSlopes; ++s) {
      for (int i = 0; i < EdgeWindow::kPlaces; ++i) {
        totals[s][i] = static_cast<std::int16_t>(totals[s][i] + response((*w.starts)[band][s] + i));
      }
    }
  }
}

}  // namespace bole
#endif  // HWY_ONCE
