#include "detect/network/dense_layer.h"

#include <algorithm>
#include <cstring>

#include "detect/rounding.h"

// Vectors of scalable length are left out: they cannot stand in arrays.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "detect/network/dense_layer.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef BOLE_DETECT_DENSE_LAYER_ONCE
#define BOLE_DETECT_DENSE_LAYER_ONCE
namespace bole {
namespace {

constexpr float kUnit = 1.0F / (float{kInputUnits} * float{kWeightUnits});
static_assert(kMostInput * float{kInputUnits} < kFar);

const std::int16_t* window_at(const Windows& windows, int index) {
  return windows.first + index / windows.across * windows.row_step +
         index % windows.across * windows.step;
}

Windows one_after_the_other(const std::int16_t* in, int looks, int pairs) {
  return {
      .first = in, .rows = 1, .across = looks, .step = 2 * pairs, .runs = 1, .run_pairs = pairs};
}

std::int16_t to_whole_units(float value, float limit) {
  const float bound = std::clamp(value, -limit, limit);
  return static_cast<std::int16_t>(static_cast<int>(bound * float{kInputUnits} + (kFar + 0.5F)) -
                                   static_cast<int>(kFar));
}

}  // namespace
}  // namespace bole
#endif

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR  // a processor without vectors

void Convolve(const Windows& windows, const std::int16_t* weights, const float* bias, int units,
              float* out) {
  convolve_plain(windows, weights, bias, units, out);
}

#else

// So many windows and vectors of units at a time that weights and inputs are read seldom, and all
// sums stay in registers.
template <int kWindows, int kVectors>
void SumUnits(const Windows& windows, int first, const std::int16_t* HWY_RESTRICT weights,
              const float* HWY_RESTRICT bias, int units, float* HWY_RESTRICT out) {
  const hn::CappedTag<std::int32_t, 16> d;
  const hn::Repartition<std::int16_t, decltype(d)> d16;
  const hn::RebindToFloat<decltype(d)> df;
  const auto lanes = static_cast<std::ptrdiff_t>(hn::Lanes(d));
  const std::int16_t* at[kWindows];
  for (int w = 0; w < kWindows; ++w) at[w] = window_at(windows, first + w);
  hn::Vec<decltype(d)> sums[kWindows][kVectors], more[kWindows][kVectors];
  for (int w = 0; w < kWindows; ++w)
    for (int v = 0; v < kVectors; ++v) sums[w][v] = more[w][v] = hn::Zero(d);
  for (std::ptrdiff_t run = 0; run < windows.runs; ++run) {
    const std::ptrdiff_t start = run * windows.run_step, end = start + 2 * windows.run_pairs;
    for (std::ptrdiff_t i = start; i < end; i += 2, weights += 2 * units) {
      hn::Vec<decltype(d16)> pair[kWindows];
      for (int w = 0; w < kWindows; ++w) {
        std::int32_t both = 0;
        std::memcpy(&both, at[w] + i, sizeof both);
        pair[w] = hn::BitCast(d16, hn::Set(d, both));
      }
      for (int v = 0; v < kVectors; ++v) {
        const auto weight = hn::LoadU(d16, weights + 2 * v * lanes);
        for (int w = 0; w < kWindows; ++w)
          sums[w][v] = hn::ReorderWidenMulAccumulate(d, weight, pair[w], sums[w][v], more[w][v]);
      }
    }
  }
  for (int w = 0; w < kWindows; ++w, out += units) {
    for (int v = 0; v < kVectors; ++v) {
      const auto total = hn::ConvertTo(df, hn::RearrangeToOddPlusEven(sums[w][v], more[w][v]));
      const auto value =
          hn::Add(hn::LoadU(df, bias + v * lanes), hn::Mul(total, hn::Set(df, kUnit)));
      hn::StoreU(hn::Max(value, hn::Mul(value, hn::Set(df, kLeak))), df, out + v * lanes);
    }
  }
}

template <int kVectors>
void SumWindows(const Windows& windows, const std::int16_t* HWY_RESTRICT weights,
                const float* HWY_RESTRICT bias, int units, float* HWY_RESTRICT out) {
  constexpr int kAtOnce = kVectors == 1 ? 2 * kLooksAtOnce : kLooksAtOnce;
  const int step = kVectors * static_cast<int>(hn::Lanes(hn::CappedTag<std::int32_t, 16>()));
  const int count = windows.rows * windows.across;
  for (int first = 0; first < count;) {
    const bool all = count - first >= kAtOnce;
    for (std::ptrdiff_t j = 0; j < units; j += step) {
      (all ? SumUnits<kAtOnce, kVectors> : SumUnits<1, kVectors>)(windows, first, weights + 2 * j,
                                                                  bias + j, units,
                                                                  out + first * units + j);
    }
    first += all ? kAtOnce : 1;
  }
}

void Convolve(const Windows& windows, const std::int16_t* HWY_RESTRICT weights,
              const float* HWY_RESTRICT bias, int units, float* HWY_RESTRICT out) {
  const int lanes = static_cast<int>(hn::Lanes(hn::CappedTag<std::int32_t, 16>()));
  if (units % (3 * lanes) == 0) {
    SumWindows<3>(windows, weights, bias, units, out);
  } else if (units % (2 * lanes) == 0) {
    SumWindows<2>(windows, weights, bias, units, out);
  } else {
    SumWindows<1>(windows, weights, bias, units, out);
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

HWY_INLINE hn::Vec<hn::Rebind<std::int16_t, hn::CappedTag<float, 16>>> WholeUnits(
    hn::Vec<hn::CappedTag<float, 16>> value, hn::Vec<hn::CappedTag<float, 16>> most) {
  const hn::CappedTag<float, 16> d;
  const hn::RebindToSigned<decltype(d)> di;
  const auto bound = hn::Min(most, hn::Max(hn::Neg(most), value));
  const auto units =
      hn::Add(hn::Mul(bound, hn::Set(d, float{kInputUnits})), hn::Set(d, kFar + 0.5F));
  const auto whole =
      hn::Sub(hn::ConvertTo(di, units), hn::Set(di, static_cast<std::int32_t>(kFar)));
  return hn::DemoteTo(hn::Rebind<std::int16_t, decltype(d)>(), whole);
}

// The last vector ends where the numbers do, and may overlap the one before.
void Standardise(const float* HWY_RESTRICT in, int count, const float* HWY_RESTRICT mean,
                 const float* HWY_RESTRICT scale, float limit, std::int16_t* HWY_RESTRICT out) {
  const hn::CappedTag<float, 16> d;
  const hn::Rebind<std::int16_t, decltype(d)> d16;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto most = hn::Set(d, limit);
  for (int start = 0; start < count; start += lanes) {
    const int i = std::min(start, count - lanes);
    const auto value =
        hn::Mul(hn::Sub(hn::LoadU(d, in + i), hn::LoadU(d, mean + i)), hn::LoadU(d, scale + i));
    hn::StoreU(WholeUnits(value, most), d16, out + i);
  }
}

void Quantise(const float* HWY_RESTRICT in, int count, std::int16_t* HWY_RESTRICT out) {
  const hn::CappedTag<float, 16> d;
  const hn::Rebind<std::int16_t, decltype(d)> d16;
  const auto most = hn::Set(d, kMostInput);
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d)))
    hn::StoreU(WholeUnits(hn::LoadU(d, in + i), most), d16, out + i);
}

}  // namespace bole::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bole {

HWY_EXPORT(Convolve);
HWY_EXPORT(AddProducts);
HWY_EXPORT(Standardise);
HWY_EXPORT(Quantise);

void convolve(const Windows& windows, const std::int16_t* weights, const float* bias, int units,
              float* out) {
  HWY_DYNAMIC_DISPATCH(Convolve)(windows, weights, bias, units, out);
}

void hidden_layer(const std::int16_t* in, int looks, int pairs, const std::int16_t* weights,
                  const float* bias, int units, float* out) {
  convolve(one_after_the_other(in, looks, pairs), weights, bias, units, out);
}

void hidden_layer_plain(const std::int16_t* in, int looks, int pairs, const std::int16_t* weights,
                        const float* bias, int units, float* out) {
  convolve_plain(one_after_the_other(in, looks, pairs), weights, bias, units, out);
}

void convolve_plain(const Windows& windows, const std::int16_t* weights, const float* bias,
                    int units, float* out) {
  for (int window = 0; window < windows.rows * windows.across; ++window) {
    const std::int16_t* const in = window_at(windows, window);
    for (int j = 0; j < units; ++j) {
      std::int32_t sum = 0;
      const std::int16_t* weight = weights + 2 * j;
      for (int run = 0; run < windows.runs; ++run) {
        const std::int16_t* pair = in + run * windows.run_step;
        for (int i = 0; i < windows.run_pairs; ++i, pair += 2, weight += 2 * units)
          sum += pair[0] * weight[0] + pair[1] * weight[1];
      }
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
  for (int i = 0; i < count; ++i) out[i] = to_whole_units((in[i] - mean[i]) * scale[i], limit);
}

void quantise(const float* in, int count, std::int16_t* out) {
  HWY_DYNAMIC_DISPATCH(Quantise)(in, count, out);
}

void quantise_plain(const float* in, int count, std::int16_t* out) {
  for (int i = 0; i < count; ++i) out[i] = to_whole_units(in[i], kMostInput);
}

}  // namespace bole
#endif  // HWY_ONCE
