#pragma once

namespace bole {

/// sums[j] += in[i] weights[i][j] for all i, in their order and rounded after each step, so that
/// the sums are the same on every processor. `units` is 8 or a multiple of 48.
void add_dense(const float* in, int count, const float* weights, int units, float* sums);
void add_dense_plain(const float* in, int count, const float* weights, int units, float* sums);

/// out[i] = (in[i] - mean[i]) scale[i], cut off at limit on either side. `count` is at least 16.
void standardise(const float* in, int count, const float* mean, const float* scale, float limit,
                 float* out);
void standardise_plain(const float* in, int count, const float* mean, const float* scale,
                       float limit, float* out);

}  // namespace bole
