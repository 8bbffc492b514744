#include "detect/dense_layer.h"

#include <algorithm>
#include <cstring>

#include "detect/rounding.h"

// Vectors of scalable length are left out: they cannot stand in arrays.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detect/dense_layer.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef BOLE_DETECT_DENSE_LAYER_ONCE
#define BOLE_DETECT_DENSE_LAYER_ONCE
namespace bole {
namespace {

constexpr float kUnit = 1.0F / (float{kInputUnits} * float{kWeightUnits});
static_assert(kMostInput * float{kInputUnits} < kFar);

}  // namespace
}  // namespace bole
#endif

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR  // a processor without vectors

void HiddenLayer(const std::int16_t* in, int looks, int pairs, const std::int16_t* weights,
                 const float* bias, int units, float* out) {
  hidden_layer_plain(in, looks, pairs, weights, bias, units, out);
}

#else

// So many looks and vectors of units at a time that weights and inputs are read seldom, and all
// sums stay in registers.
template <int kLooks, int kVectors>
void SumUnits(const std::int16_t* HWY_RESTRICT in, int pairs,
              const std::int16_t* HWY_RESTRICT weights, const float* HWY_RESTRICT bias, int units,
              float* HWY_RESTRICT out) {
  const hn::CappedTag<std::int32_t, 16> d;
  const hn::Repartition<std::int16_t, decltype(d)> d16;
  const hn::RebindToFloat<decltype(d)> df;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  hn::Vec<decltype(d)> sums[kLooks][kVectors], more[kLooks][kVectors];
  for (int look = 0; look < kLooks; ++look)
    for (int v = 0; v < kVectors; ++v) sums[look][v] = more[look][v] = hn::Zero(d);
  for (std::ptrdiff_t i = 0; i < pairs; ++i, weights += 2 * units) {
    hn::Vec<decltype(d16)> pair[kLooks];
    for (int look = 0; look < kLooks; ++look) {
      std::int32_t both = 0;
      std::memcpy(&both, in + 2 * (look * pairs + i), sizeof both);
      pair[look] = hn::BitCast(d16, hn::Set(d, both));
    }
    for (int v = 0; v < kVectors; ++v) {
      const auto weight = hn::LoadU(d16, weights + 2 * v * lanes);
      for (int look = 0; look < kLooks; ++look) {
        sums[look][v] =
            hn::ReorderWidenMulAccumulate(d, weight, pair[look], sums[look][v], more[look][v]);
      }
    }
  }
  for (int look = 0; look < kLooks; ++look) {
    for (int v = 0; v < kVectors; ++v) {
      const auto total =
          hn::ConvertTo(df, hn::RearrangeToOddPlusEven(sums[look][v], more[look][v]));
      const auto value =
          hn::Add(hn::LoadU(df, bias + v * lanes), hn::Mul(total, hn::Set(df, kUnit)));
      hn::StoreU(hn::Max(value, hn::Mul(value, hn::Set(df, kLeak))), df,
                 out + look * units + v * lanes);
    }
  }
}

void HiddenLayer(const std::int16_t* HWY_RESTRICT in, int looks, int pairs,
                 const std::int16_t* HWY_RESTRICT weights, const float* HWY_RESTRICT bias,
                 int units, float* HWY_RESTRICT out) {
  const int step = 3 * static_cast<int>(hn::Lanes(hn::CappedTag<std::int32_t, 16>()));
  for (int look = 0; look < looks;) {
    const bool all = looks - look >= kLooksAtOnce;
    for (std::ptrdiff_t j = 0; j < units; j += step) {
      (all ? SumUnits<kLooksAtOnce, 3> : SumUnits<1, 3>)(in + std::ptrdiff_t{2} * look * pairs,
                                                         pairs, weights + 2 * j, bias + j, units,
                                                         out + look * units + j);
    }
    look += all ? kLooksAtOnce : 1;
  }
}

#endif  // HWY_TARGET

template <class D, int kVectors>
HWY_INLINE void AddSome(const float* HWY_RESTRICT in, int count, const float* HWY_RESTRICT weights,
                        int units, float* HWY_RESTRICT out) {
  const D d;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  hn::Vec<D> parts[4][kVectors];
  for (auto& part : parts)
    for (auto& sum : part) sum = hn::Zero(d);
  for (std::ptrdiff_t i = 0; i < count; i += 4) {
    for (int p = 0; p < 4; ++p) {
      const auto value = hn::Set(d, in[i + p]);
      for (int v = 0; v < kVectors; ++v) {
        const auto weight = hn::LoadU(d, weights + (i + p) * units + v * lanes);
        parts[p][v] = hn::Add(parts[p][v], hn::Mul(value, weight));
      }
    }
  }
  for (int v = 0; v < kVectors; ++v, out += lanes) {
    const auto sum = hn::Add(hn::Add(parts[0][v], parts[1][v]), hn::Add(parts[2][v], parts[3][v]));
    hn::StoreU(hn::Add(hn::LoadU(d, out), sum), d, out);
  }
}

void AddProducts(const float* HWY_RESTRICT in, int count, const float* HWY_RESTRICT weights,
                 int units, float* HWY_RESTRICT out) {
  using Wide = hn::CappedTag<float, 16>;
  using Narrow = hn::CappedTag<float, 8>;
  const int wide = 3 * static_cast<int>(hn::Lanes(Wide()));
  const int narrow = static_cast<int>(hn::Lanes(Narrow()));
  if (units % wide == 0) {
    for (int k = 0; k < units; k += wide) AddSome<Wide, 3>(in, count, weights + k, units, out + k);
  } else {
    for (int k = 0; k < units; k += narrow)
      AddSome<Narrow, 1>(in, count, weights + k, units, out + k);
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

void hidden_layer(const std::int16_t* in, int looks, int pairs, const std::int16_t* weights,
                  const float* bias, int units, float* out) {
  HWY_DYNAMIC_DISPATCH(HiddenLayer)(in, looks, pairs, weights, bias, units, out);
}

void hidden_layer_plain(const std::int16_t* in, int looks, int pairs, const std::int16_t* weights,
                        const float* bias, int units, float* out) {
  for (int look = 0; look < looks; ++look, in += 2 * pairs) {
    for (int j = 0; j < units; ++j) {
      std::int32_t sum = 0;
      for (int i = 0; i < 2 * pairs; ++i)
        sum += in[i] * weights[(i / 2) * 2 * units + 2 * j + i % 2];
      const float value = bias[j] + static_cast<float>(sum) * kUnit;
      *out++ = std::max(value, value * kLeak);
    }
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
