#pragma once

#include <cstdint>

namespace bole {

/// The inner loops of Templates, in whole vectors of whatever this processor has, and the plain
/// loops that say what they must give. Arrays may be read and written up to kTemplateChunk - 1
/// elements beyond what is asked for.
inline constexpr int kTemplateChunk = 64;

/// A response to an edge in eight bits: kNoResponse and at most kFullResponse more or, where the
/// brightness falls, less.
inline constexpr int kFullResponse = 96;  ///< of an edge of full contrast
inline constexpr int kNoResponse = 128;

/// out[i] = sum[i step]; step is 2 or 4.
void thin_sums(const std::uint16_t* sum, int step, int count, std::uint16_t* out);
void thin_sums_plain(const std::uint16_t* sum, int step, int count, std::uint16_t* out);

/// The response to bend = sum[i + flank] - 2 sum[i] + sum[i - flank]: bend factor / 2^15, rounded,
/// cut off at kFullResponse on either side. sum is modulo 2^16, bend within 2^15.
void edge_responses(const std::uint16_t* sum, int flank, std::int16_t factor, int count,
                    std::uint8_t* out);
void edge_responses_plain(const std::uint16_t* sum, int flank, std::int16_t factor, int count,
                          std::uint8_t* out);

/// The same above the horizon, where a trunk may be darker than what is on one side of it and
/// brighter than what is on the other.
struct ResponsesAbove {
  std::uint8_t* right_sign = nullptr;  ///< 5/8 of the response
  /// 13/32 of it or, where it has the wrong sign, of 11/16 of it without; never below
  /// kNoResponse + 1. [0]: rising brightness is right, [1]: falling.
  std::uint8_t* either_sign[2] = {nullptr, nullptr};
};
void edge_responses_above(const std::uint16_t* sum, int flank, std::int16_t factor, int count,
                          const ResponsesAbove& out);
void edge_responses_above_plain(const std::uint16_t* sum, int flank, std::int16_t factor, int count,
                                const ResponsesAbove& out);

/// What is summed down the columns, and where the results go.
struct EvidenceSums {
  /// Bands x pitch; a trunk's right edge lies `across` elements after its left one. Above the
  /// horizon ResponsesAbove.
  const std::uint8_t* responses = nullptr;
  const std::uint8_t* either_sign[2] = {nullptr, nullptr};  ///< horizon x pitch
  int pitch = 0, across = 0;
  int horizon = 0;                    ///< the first band below it
  int first_foot = 0, last_foot = 0;  ///< trunks end at the lower border of one of these
  int count = 0;                      ///< left edges
  std::int16_t* evidence[2] = {nullptr, nullptr};  ///< dark, bright: the highest sum
  std::int16_t* foot[2] = {nullptr, nullptr};      ///< bands above its end; 0: no evidence
};

/// For every left edge, with l and r the responses of a dark trunk's two edges: the sum of
/// joined(l, r) - 30 over the bands, started anew at 0 wherever it falls below, where joined(l, r)
/// is (l + r) / 4 + min(l, r) / 2, its halves rounded up. Above the horizon the higher one of what
/// either response of ResponsesAbove gives less 24.
void sum_evidence(const EvidenceSums& sums);
void sum_evidence_plain(const EvidenceSums& sums);

/// Writes the places i < count, ascending, where evidence[i] is at least `least`, not below that of
/// the `reach` places before it and above that of the `reach` places after it; returns how many.
/// `evidence` may be read `reach` elements beyond either end, `places` has room for `count`.
int find_peaks(const std::int16_t* evidence, int count, int least, int reach, int* places);
int find_peaks_plain(const std::int16_t* evidence, int count, int least, int reach, int* places);

}  // namespace bole
