#pragma once

#include <cstdint>

namespace bole {

/// The inner loops of Bands, in whole vectors of whatever this processor has, and the plain loops
/// that say what they must give.

/// out[x] = rows[0][x] + rows[1][x] + rows[2][x] + rows[3][x].
void sum_four_rows(const std::uint8_t* const rows[4], int width, std::uint16_t* out);
void sum_four_rows_plain(const std::uint8_t* const rows[4], int width, std::uint16_t* out);

/// to[i] = from[i] + shift, modulo 2^16. The two do not overlap.
void shift_sums(const std::uint16_t* from, int count, std::uint16_t shift, std::uint16_t* to);
void shift_sums_plain(const std::uint16_t* from, int count, std::uint16_t shift, std::uint16_t* to);

}  // namespace bole
