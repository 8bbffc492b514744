// Included by warp_rows.cpp once for each instruction set; no include guard for that reason.
// The kernel for processors that look up 64 bytes in 128 of them in one instruction (AVX-512 VBMI),
// which Highway does not offer by a name of its own.

#if HWY_TARGET <= HWY_AVX3_DL

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {
namespace {

HWY_INLINE __m512i two_rows_of_32(const std::uint8_t* from, std::ptrdiff_t stride) {
  const __m256i first = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
  const __m256i second = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from + stride));
  return _mm512_inserti64x4(_mm512_castsi256_si512(first), second, 1);
}

HWY_INLINE __m512i four_rows_of_16(const std::uint8_t* from, std::ptrdiff_t stride) {
  const auto row = [&](int i) {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from + i * stride));
  };
  const __m256i first = _mm256_inserti128_si256(_mm256_castsi128_si256(row(0)), row(1), 1);
  const __m256i second = _mm256_inserti128_si256(_mm256_castsi128_si256(row(2)), row(3), 1);
  return _mm512_inserti64x4(_mm512_castsi256_si512(first), second, 1);
}

HWY_INLINE __m512i eight_rows_of_8(const std::uint8_t* from, std::ptrdiff_t stride) {
  const auto two = [&](int i) {
    const __m128i first = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(from + i * stride));
    return _mm_castpd_si128(_mm_loadh_pd(_mm_castsi128_pd(first),
                                         reinterpret_cast<const double*>(from + (i + 1) * stride)));
  };
  const __m256i first = _mm256_inserti128_si256(_mm256_castsi128_si256(two(0)), two(2), 1);
  const __m256i second = _mm256_inserti128_si256(_mm256_castsi128_si256(two(4)), two(6), 1);
  return _mm512_inserti64x4(_mm512_castsi256_si512(first), second, 1);
}

// Of 128 bytes, every other one; `odd`: from the second on.
HWY_INLINE __m512i every_other(__m512i first, __m512i second, bool odd) {
  alignas(64) static constexpr auto kEven = [] {
    std::array<std::uint8_t, 64> even{};
    for (std::size_t i = 0; i < even.size(); ++i) even[i] = static_cast<std::uint8_t>(2 * i);
    return even;
  }();
  const __m512i pick =
      _mm512_add_epi8(_mm512_load_si512(kEven.data()), _mm512_set1_epi8(odd ? 1 : 0));
  return _mm512_permutex2var_epi8(first, pick, second);
}

// The samples of a window of the smaller side.
template <int kPixelBytes>
struct SmallSamples {
  static constexpr int kSide = WarpWindow::kSmallSide;
  __m512i samples;

  // `odd`: of two bytes a pixel, the second is the sample.
  SmallSamples(const std::uint8_t* from, std::ptrdiff_t stride, bool odd)
      : samples(kPixelBytes == 1 ? eight_rows_of_8(from, stride)
                                 : every_other(four_rows_of_16(from, stride),
                                               four_rows_of_16(from + 4 * stride, stride), odd)) {}

  // The samples at `place`, for 64 pixels.
  HWY_INLINE __m512i at(__m512i place) const { return _mm512_permutexvar_epi8(place, samples); }
};

// As SmallSamples, of a window of the larger side.
template <int kPixelBytes>
struct LargeSamples {
  static constexpr int kSide = WarpWindow::kSide;
  __m512i rows[4];  // four rows each

  LargeSamples(const std::uint8_t* from, std::ptrdiff_t stride, bool odd) {
    for (int k = 0; k < 4; ++k, from += 4 * stride) {
      rows[k] = kPixelBytes == 1 ? four_rows_of_16(from, stride)
                                 : every_other(two_rows_of_32(from, stride),
                                               two_rows_of_32(from + 2 * stride, stride), odd);
    }
  }

  HWY_INLINE __m512i at(__m512i place) const {
    const __m512i upper = _mm512_permutex2var_epi8(rows[0], place, rows[1]);
    const __m512i lower = _mm512_permutex2var_epi8(rows[2], place, rows[3]);
    return _mm512_mask_blend_epi8(_mm512_movepi8_mask(place), upper, lower);
  }
};

struct Halves {  // of each 128 bits of a vector, widened
  __m512i low, high;
};

// Between neighbours: kWarpSteps times the sample.
template <class Window>
HWY_INLINE Halves across(const Window& samples, __m512i place, Halves weights) {
  const __m512i left = samples.at(place);
  const __m512i right = samples.at(_mm512_add_epi8(place, _mm512_set1_epi8(1)));
  return {_mm512_maddubs_epi16(_mm512_unpacklo_epi8(left, right), weights.low),
          _mm512_maddubs_epi16(_mm512_unpackhi_epi8(left, right), weights.high)};
}

// `step`: of the row, times 2^9, so that the product's upper half is (step difference + 32) >> 6.
HWY_INLINE __m512i down(__m512i above, __m512i below, __m512i step) {
  const __m512i sum =
      _mm512_add_epi16(above, _mm512_mulhrs_epi16(_mm512_sub_epi16(below, above), step));
  return _mm512_srli_epi16(_mm512_add_epi16(sum, _mm512_set1_epi16(kWarpSteps / 2)), kWarpBits);
}

template <class Window>
HWY_INLINE __m512i interpolate(const Window& samples, const WarpWindow& window) {
  const __m512i place = _mm512_load_si512(window.place.data());
  const __m512i u = _mm512_load_si512(window.column_step.data());
  const __m512i v = _mm512_load_si512(window.row_step.data());
  const __m512i rest = _mm512_sub_epi8(_mm512_set1_epi8(kWarpSteps), u);
  const Halves weights{_mm512_unpacklo_epi8(rest, u), _mm512_unpackhi_epi8(rest, u)};
  const Halves above = across(samples, place, weights);
  const Halves below =
      across(samples, _mm512_add_epi8(place, _mm512_set1_epi8(Window::kSide)), weights);
  // Bytes put in the upper half of 16 bits are times 2^8.
  const __m512i zero = _mm512_setzero_si512(), v2 = _mm512_add_epi8(v, v);
  return _mm512_packus_epi16(down(above.low, below.low, _mm512_unpacklo_epi8(zero, v2)),
                             down(above.high, below.high, _mm512_unpackhi_epi8(zero, v2)));
}

HWY_INLINE void store_rows(__m512i pixels, int rows, WarpOutput out) {
  alignas(64) std::uint8_t bytes[WarpWindow::kPixels];
  _mm512_store_si512(bytes, pixels);
  for (int i = 0; i < rows; ++i, out.pixels += out.stride) {
    std::memcpy(out.pixels, bytes + i * WarpWindow::kColumns, WarpWindow::kColumns);
  }
}

HWY_INLINE void store_all_rows(__m512i pixels, WarpOutput out) {
  const auto two = [&](__m128i rows) {
    _mm_storel_epi64(reinterpret_cast<__m128i*>(out.pixels), rows);
    _mm_storeh_pd(reinterpret_cast<double*>(out.pixels + out.stride), _mm_castsi128_pd(rows));
    out.pixels += 2 * out.stride;
  };
  two(_mm512_castsi512_si128(pixels));
  two(_mm512_extracti32x4_epi32(pixels, 1));
  two(_mm512_extracti32x4_epi32(pixels, 2));
  two(_mm512_extracti32x4_epi32(pixels, 3));
}

// Half a tile, out of one of its windows.
template <class Window, int kPixelBytes>
HWY_INLINE __m512i pick(const SampledImage& image, WarpWindows::Origin origin,
                        const WarpWindow& window) {
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(image.bytes.data());
  const std::ptrdiff_t stride = image.stride;
  const std::uint8_t* const from = bytes + origin.row * stride + origin.column * kPixelBytes;
  return interpolate(Window(from, stride, image.lead == 1), window);
}

// Half a tile.
template <int kPixelBytes>
HWY_INLINE __m512i pick_half(const SampledImage& image, const WarpWindows::Half& half,
                             const WarpWindow& window) {
  using Small = SmallSamples<kPixelBytes>;
  using Large = LargeSamples<kPixelBytes>;
  if (half.small) return pick<Small, kPixelBytes>(image, half.left, window);
  const __m512i left = pick<Large, kPixelBytes>(image, half.left, window);
  if (half.right == half.left) return left;
  constexpr __mmask64 kRightColumns = 0xf0f0f0f0f0f0f0f0;  // of each row's eight
  return _mm512_mask_blend_epi8(kRightColumns, left,
                                pick<Large, kPixelBytes>(image, half.right, window));
}

// Tile number `tile` of the strip, one of those that fit.
template <int kPixelBytes>
HWY_INLINE void warp_tile_by_windows(const WarpStrip& strip, std::size_t number, int tile) {
  for (int half = 0; half < 2; ++half) {
    const __m512i pixels = pick_half<kPixelBytes>(
        strip.image, strip.windows.tile(number).halves[half], strip.windows.windows(number)[half]);
    const WarpOutput out{strip.out.pixels + tile * kTileColumns + half * WarpWindow::kColumns,
                         strip.out.stride};
    if (strip.rows == kTileRows) {
      store_all_rows(pixels, out);
    } else {
      store_rows(pixels, strip.rows, out);
    }
  }
}

}  // namespace
}  // namespace bole::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // HWY_TARGET
