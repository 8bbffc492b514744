#include "detect/dense_layer.h"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detect/dense_layer.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef BOLE_DETECT_DENSE_LAYER_ONCE
#define BOLE_DETECT_DENSE_LAYER_ONCE
namespace bole {
namespace {

constexpr float kUnit = 1.0F / (float{kInputUnits} * float{kWeightUnits});
// What is added before a truncation, so that it rounds to the nearest whole number.
constexpr float kFar = 16384;
static_assert(kMostInput * float{kInputUnits} < kFar);

}  // namespace
}  // namespace bole
#endif

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR  // a processor without vectors

void HiddenLayer(const std::int16_t* in, int pairs, const std::int16_t* weights, const float* bias,
                 int units, float* out) {
  hidden_layer_plain(in, pairs, weights, bias, units, out);
}

#else

// Three vectors of units at a time: enough of them to hide the additions' latency.
void HiddenLayer(const std::int16_t* HWY_RESTRICT in, int pairs,
                 const std::int16_t* HWY_RESTRICT weights, const float* HWY_RESTRICT bias,
                 int units, float* HWY_RESTRICT out) {
  const hn::CappedTag<std::int32_t, 16> d;
  const hn::Repartition<std::int16_t, decltype(d)> d16;
  const hn::RebindToFloat<decltype(d)> df;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  for (std::ptrdiff_t j = 0; j < units; j += 3 * lanes) {
    auto a = hn::Zero(d), b = hn::Zero(d), c = hn::Zero(d);
    auto more_a = hn::Zero(d), more_b = hn::Zero(d), more_c = hn::Zero(d);
    for (std::ptrdiff_t i = 0; i < pairs; ++i) {
      std::int32_t both = 0;
      std::memcpy(&both, in + 2 * i, sizeof both);
      const auto pair = hn::BitCast(d16, hn::Set(d, both));
      const std::int16_t* row = weights + 2 * (i * units + j);
      a = hn::ReorderWidenMulAccumulate(d, hn::LoadU(d16, row), pair, a, more_a);
      b = hn::ReorderWidenMulAccumulate(d, hn::LoadU(d16, row + 2 * lanes), pair, b, more_b);
      c = hn::ReorderWidenMulAccumulate(d, hn::LoadU(d16, row + 4 * lanes), pair, c, more_c);
    }
    const auto finish = [&](auto sum, auto more, std::ptrdiff_t at) {
      const auto total = hn::ConvertTo(df, hn::RearrangeToOddPlusEven(sum, more));
      const auto value = hn::Add(hn::LoadU(df, bias + at), hn::Mul(total, hn::Set(df, kUnit)));
      hn::StoreU(hn::Max(value, hn::Mul(value, hn::Set(df, kLeak))), df, out + at);
    };
    finish(a, more_a, j);
    finish(b, more_b, j + lanes);
    finish(c, more_c, j + 2 * lanes);
  }
}

#endif  // HWY_TARGET

void AddProducts(const float* HWY_RESTRICT in, int count, const float* HWY_RESTRICT weights,
                 int units, float* HWY_RESTRICT out) {
  const hn::CappedTag<float, 8> d;
  for (int k = 0; k < units; k += static_cast<int>(hn::Lanes(d))) {
    auto p0 = hn::Zero(d), p1 = hn::Zero(d), p2 = hn::Zero(d), p3 = hn::Zero(d);
    for (int i = 0; i < count; i += 4) {
      const auto term = [&](int at) {
        return hn::Mul(hn::Set(d, in[at]), hn::LoadU(d, weights + at * units + k));
      };
      p0 = hn::Add(p0, term(i));
      p1 = hn::Add(p1, term(i + 1));
      p2 = hn::Add(p2, term(i + 2));
      p3 = hn::Add(p3, term(i + 3));
    }
    const auto sum = hn::Add(hn::Add(p0, p1), hn::Add(p2, p3));
    hn::StoreU(hn::Add(hn::LoadU(d, out + k), sum), d, out + k);
  }
}

// The last vector ends where the numbers do, and may overlap the one before.
void Standardise(const float* HWY_RESTRICT in, int count, const float* HWY_RESTRICT mean,
                 const float* HWY_RESTRICT scale, float limit, std::int16_t* HWY_RESTRICT out) {
  const hn::CappedTag<float, 16> d;
  const hn::RebindToSigned<decltype(d)> di;
  const hn::Rebind<std::int16_t, decltype(d)> d16;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto most = hn::Set(d, limit);
  for (int start = 0; start < count; start += lanes) {
    const int i = std::min(start, count - lanes);
    const auto value =
        hn::Mul(hn::Sub(hn::LoadU(d, in + i), hn::LoadU(d, mean + i)), hn::LoadU(d, scale + i));
    const auto bound = hn::Min(most, hn::Max(hn::Neg(most), value));
    const auto units =
        hn::Add(hn::Mul(bound, hn::Set(d, float{kInputUnits})), hn::Set(d, kFar + 0.5F));
    const auto whole =
        hn::Sub(hn::ConvertTo(di, units), hn::Set(di, static_cast<std::int32_t>(kFar)));
    hn::StoreU(hn::DemoteTo(d16, whole), d16, out + i);
  }
}

}  // namespace bole::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bole {

HWY_EXPORT(HiddenLayer);
HWY_EXPORT(AddProducts);
HWY_EXPORT(Standardise);

void hidden_layer(const std::int16_t* in, int pairs, const std::int16_t* weights, const float* bias,
                  int units, float* out) {
  HWY_DYNAMIC_DISPATCH(HiddenLayer)(in, pairs, weights, bias, units, out);
}

void hidden_layer_plain(const std::int16_t* in, int pairs, const std::int16_t* weights,
                        const float* bias, int units, float* out) {
  for (int j = 0; j < units; ++j) {
    std::int32_t sum = 0;
    for (int i = 0; i < 2 * pairs; ++i) sum += in[i] * weights[(i / 2) * 2 * units + 2 * j + i % 2];
    const float value = bias[j] + static_cast<float>(sum) * kUnit;
    out[j] = std::max(value, value * kLeak);
  }
}

void add_products(const float* in, int count, const float* weights, int units, float* out) {
  HWY_DYNAMIC_DISPATCH(AddProducts)(in, count, weights, units, out);
}

void add_products_plain(const float* in, int count, const float* weights, int units, float* out) {
  for (int k = 0; k < units; ++k) {
    float parts[4] = {};
    for (int i = 0; i < count; ++i) parts[i % 4] += in[i] * weights[i * units + k];
    out[k] += (parts[0] + parts[1]) + (parts[2] + parts[3]);
  }
}

void standardise(const float* in, int count, const float* mean, const float* scale, float limit,
                 std::int16_t* out) {
  HWY_DYNAMIC_DISPATCH(Standardise)(in, count, mean, scale, limit, out);
}

void standardise_plain(const float* in, int count, const float* mean, const float* scale,
                       float limit, std::int16_t* out) {
  for (int i = 0; i < count; ++i) {
    const float value = std::clamp((in[i] - mean[i]) * scale[i], -limit, limit);
    out[i] = static_cast<std::int16_t>(
        static_cast<int>(value * float{kInputUnits} + (kFar + 0.5F)) - static_cast<int>(kFar));
  }
}

}  // namespace bole
#endif  // HWY_ONCE
