#include "detect/dense_layer.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detect/dense_layer.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Three vectors of sums at a time: enough of them to hide an addition's latency.
void AddDense(const float* HWY_RESTRICT in, int count, const float* HWY_RESTRICT weights, int units,
              float* HWY_RESTRICT sums) {
  const hn::CappedTag<float, 16> d;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  for (std::ptrdiff_t j = 0; j < units; j += 3 * lanes) {
    auto a = hn::LoadU(d, sums + j), b = hn::LoadU(d, sums + j + lanes);
    auto c = hn::LoadU(d, sums + j + 2 * lanes);
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      const auto value = hn::Set(d, in[i]);
      const float* row = weights + i * units + j;
      a = hn::Add(a, hn::Mul(value, hn::LoadU(d, row)));
      b = hn::Add(b, hn::Mul(value, hn::LoadU(d, row + lanes)));
      c = hn::Add(c, hn::Mul(value, hn::LoadU(d, row + 2 * lanes)));
    }
    hn::StoreU(a, d, sums + j);
    hn::StoreU(b, d, sums + j + lanes);
    hn::StoreU(c, d, sums + j + 2 * lanes);
  }
}

}  // namespace bole::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bole {

HWY_EXPORT(AddDense);

void add_dense(const float* in, int count, const float* weights, int units, float* sums) {
  HWY_DYNAMIC_DISPATCH(AddDense)(in, count, weights, units, sums);
}

void add_dense_plain(const float* in, int count, const float* weights, int units, float* sums) {
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < units; ++j) sums[j] += in[i] * weights[i * units + j];
}

}  // namespace bole
#endif  // HWY_ONCE
