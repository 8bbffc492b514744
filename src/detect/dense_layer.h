#pragma once

namespace bole {

/// sums[j] += in[i] weights[i][j] for all i, in their order and rounded after each step, so that
/// the sums are the same on every processor. `units` is a multiple of 48.
void add_dense(const float* in, int count, const float* weights, int units, float* sums);
void add_dense_plain(const float* in, int count, const float* weights, int units, float* sums);

}  // namespace bole
