#include "detect/dense_layer.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detect/dense_layer.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Three vectors of sums at a time: enough of them to hide an addition's latency.
void AddWide(const float* HWY_RESTRICT in, int count, const float* HWY_RESTRICT weights, int units,
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

void AddDense(const float* HWY_RESTRICT in, int count, const float* HWY_RESTRICT weights, int units,
              float* HWY_RESTRICT sums) {
  if (units != 8) return AddWide(in, count, weights, units, sums);
  const hn::CappedTag<float, 8> d;
  for (int j = 0; j < units; j += static_cast<int>(hn::Lanes(d))) {
    auto sum = hn::LoadU(d, sums + j);
    for (int i = 0; i < count; ++i)
      sum = hn::Add(sum, hn::Mul(hn::Set(d, in[i]), hn::LoadU(d, weights + i * units + j)));
    hn::StoreU(sum, d, sums + j);
  }
}

// The last vector ends where the numbers do, and may overlap the one before.
void Standardise(const float* HWY_RESTRICT in, int count, const float* HWY_RESTRICT mean,
                 const float* HWY_RESTRICT scale, float limit, float* HWY_RESTRICT out) {
  const hn::CappedTag<float, 16> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto most = hn::Set(d, limit);
  for (int start = 0; start < count; start += lanes) {
    const int i = std::min(start, count - lanes);
    const auto value =
        hn::Mul(hn::Sub(hn::LoadU(d, in + i), hn::LoadU(d, mean + i)), hn::LoadU(d, scale + i));
    hn::StoreU(hn::Min(most, hn::Max(hn::Neg(most), value)), d, out + i);
  }
}

}  // namespace bole::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bole {

HWY_EXPORT(AddDense);
HWY_EXPORT(Standardise);

void add_dense(const float* in, int count, const float* weights, int units, float* sums) {
  HWY_DYNAMIC_DISPATCH(AddDense)(in, count, weights, units, sums);
}

void add_dense_plain(const float* in, int count, const float* weights, int units, float* sums) {
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < units; ++j) sums[j] += in[i] * weights[i * units + j];
}

void standardise(const float* in, int count, const float* mean, const float* scale, float limit,
                 float* out) {
  HWY_DYNAMIC_DISPATCH(Standardise)(in, count, mean, scale, limit, out);
}

void standardise_plain(const float* in, int count, const float* mean, const float* scale,
                       float limit, float* out) {
  for (int i = 0; i < count; ++i) out[i] = std::clamp((in[i] - mean[i]) * scale[i], -limit, limit);
}

}  // namespace bole
#endif  // HWY_ONCE
