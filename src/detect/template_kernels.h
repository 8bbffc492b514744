#pragma once

#include <cstdint>

namespace bole {

/// The inner loops of Templates, in whole vectors of whatever this processor has, and the plain
/// loops that say what they must give. Arrays may be read and written up to kTemplateChunk - 1
/// elements beyond what is asked for.
inline constexpr int kTemplateChunk = 64;

inline constexpr int kFullResponse = 64;  ///< of an edge of full contrast

/// out[i] = (|bend| factor) / 2^16 with the sign of bend = sum[x + flank] - 2 sum[x] +
/// sum[x - flank], x = i step; rounded towards zero and cut off at kFullResponse on either side.
/// sum is modulo 2^16, bend within 2^15; step is 1, 2 or 4.
void edge_responses(const std::uint16_t* sum, int flank, int step, std::uint16_t factor, int count,
                    std::int16_t* out);
void edge_responses_plain(const std::uint16_t* sum, int flank, int step, std::uint16_t factor,
                          int count, std::int16_t* out);

/// What is summed down the columns, and where the results go.
struct ColumnSums {
  const std::int16_t* responses = nullptr;  ///< bands x pitch; a trunk's right edge lies `across`
  int pitch = 0, across = 0;                ///< elements after its left one
  int horizon = 0;                          ///< the first band below it
  int first_foot = 0, last_foot = 0;        ///< trunks end at the lower border of one of these
  int count = 0;                            ///< left edges
  std::int16_t* evidence[2] = {nullptr, nullptr};  ///< dark, bright: the highest sum
  std::int16_t* foot[2] = {nullptr, nullptr};      ///< bands above its end; 0: no evidence
};

/// For every left edge, with l and r the responses of a dark trunk's two edges: the sum of
/// (l + r) / 4 + min(l, r) / 2 - 19 over the bands, started anew at 0 wherever it falls below.
/// Above the horizon a response of the wrong sign counts 11 / 16 of one of the right sign, and the
/// band's value is ((l + r) / 4 + min(l, r) / 2 - 35) 13 / 32. All divisions round down.
void sum_columns(const ColumnSums& sums);
void sum_columns_plain(const ColumnSums& sums);

/// Writes the places i < count, ascending, where evidence[i] is at least `least`, not below that of
/// the `reach` places before it and above that of the `reach` places after it; returns how many.
/// `evidence` may be read `reach` elements beyond either end, `places` has room for `count`.
int find_peaks(const std::int16_t* evidence, int count, int least, int reach, int* places);
int find_peaks_plain(const std::int16_t* evidence, int count, int least, int reach, int* places);

}  // namespace bole
