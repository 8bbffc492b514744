#pragma once

#include <cstddef>
#include <cstdint>

namespace bole {

/// The inner loops of the networks, in whole vectors of whatever this processor has, and the plain
/// loops that say what they must give: equal results.
///
/// Wide layers are summed in whole numbers, which are the same in any order, half as long as
/// floats and multiplied two at a time: inputs in units of 1 / kInputUnits, weights of
/// 1 / kWeightUnits.
inline constexpr int kInputUnits = 2048, kWeightUnits = 2048;
inline constexpr float kMostInput = 4;            ///< absolute value of an input
inline constexpr float kMostWeight = 15;          ///< of a weight
inline constexpr float kMostWeightsOfUnit = 120;  ///< sum of one unit's: the total stays below 2^31

inline constexpr float kLeak = 0.05F;  ///< of a unit whose sum is negative

/// out[i] = (in[i] - mean[i]) scale[i], cut off at `limit` on either side, to the nearest unit.
/// `count` is at least 16, `limit` at most kMostInput.
void standardise(const float* in, int count, const float* mean, const float* scale, float limit,
                 std::int16_t* out);
void standardise_plain(const float* in, int count, const float* mean, const float* scale,
                       float limit, std::int16_t* out);

/// out[i] = in[i], cut off at kMostInput on either side, to the nearest unit. `count` is a
/// multiple of 16.
void quantise(const float* in, int count, std::int16_t* out);
void quantise_plain(const float* in, int count, std::int16_t* out);

/// For each of `looks` inputs and outputs, one after the other: out[j] = v or, where that is more,
/// v kLeak; v = bias[j] + the sum of in[i] weight(i, j), where
/// weight(i, j) = weights[(i / 2) 2 units + 2 j + i % 2]. `units` is a multiple of 16. Four looks
/// at a time read the weights once.
inline constexpr int kLooksAtOnce = 4;
void hidden_layer(const std::int16_t* in, int looks, int pairs, const std::int16_t* weights,
                  const float* bias, int units, float* out);
void hidden_layer_plain(const std::int16_t* in, int looks, int pairs, const std::int16_t* weights,
                        const float* bias, int units, float* out);

/// Inputs that lie in a picture: each is a window, the pairs of its runs one after the other, at
/// every `step`-th element of a row and every `row_step`-th of the rows. Runs may overlap.
struct Windows {
  const std::int16_t* first = nullptr;
  int rows = 0, across = 0;               ///< windows
  std::ptrdiff_t step = 0, row_step = 0;  ///< elements, from a window to the next
  int runs = 0, run_pairs = 0;
  std::ptrdiff_t run_step = 0;  ///< elements, from a run of a window to its next
};

/// The same as hidden_layer for each of them, row by row.
void convolve(const Windows& windows, const std::int16_t* weights, const float* bias, int units,
              float* out);
void convolve_plain(const Windows& windows, const std::int16_t* weights, const float* bias,
                    int units, float* out);

/// out[k] += in[i] weights[i units + k]. Inputs are summed in four parts, i % 4 alike, of which 0
/// and 1, and 2 and 3 are joined first. `count` is a multiple of 4, `units` of 8.
void add_products(const float* in, int count, const float* weights, int units, float* out);
void add_products_plain(const float* in, int count, const float* weights, int units, float* out);

}  // namespace bole
