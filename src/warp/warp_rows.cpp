#include "warp/warp_rows.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

// The kernels below are compiled once for each instruction set. Vectors of scalable length are left
// out: source pixels come one by one whatever the length.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#define HWY_WANT_AVX3_DL
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "warp/warp_rows.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include <hwy/highway.h>

#include "warp/warp_window-inl.h"

HWY_BEFORE_NAMESPACE();
namespace bole::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR  // a processor without vectors

void warp_strip(const WarpStrip& strip) {
  for (int tile = 0; tile < strip.table.tiles_per_strip(); ++tile) warp_tile_plain(strip, tile);
}

#else

namespace hn = hwy::HWY_NAMESPACE;

using D32 = hn::CappedTag<std::uint32_t, kTileColumns>;
using V32 = hn::Vec<D32>;

// Each lane of a and b is a pair of 16-bit numbers below 2^15: a.low b.low + a.high b.high.
HWY_INLINE V32 multiply_add_pairs(D32 d, V32 a, V32 b) {
#if HWY_TARGET <= HWY_SSSE3
  const hn::RebindToSigned<D32> di32;
  const hn::RepartitionToNarrow<decltype(di32)> di16;
  auto none = hn::Zero(di32);  // one instruction there, nothing goes to the second sum
  return hn::BitCast(d, hn::ReorderWidenMulAccumulate(di32, hn::BitCast(di16, a),
                                                      hn::BitCast(di16, b), none, none));
#else
  const V32 low = hn::Set(d, 0xffff);
  return hn::Add(hn::Mul(hn::And(a, low), hn::And(b, low)),
                 hn::Mul(hn::ShiftRight<16>(a), hn::ShiftRight<16>(b)));
#endif
}

HWY_INLINE std::uint32_t four_bytes(const std::uint8_t* from) {
  std::uint32_t bytes;
  std::memcpy(&bytes, from, sizeof bytes);
  return bytes;
}

// The four bytes at base + offset, for each lane. Where there are gather instructions, loads one by
// one were measured to be faster all the same.
template <class D>
HWY_INLINE hn::Vec<D> load_scattered(D d, const std::uint8_t* base, const std::uint32_t* offsets) {
  if constexpr (hn::MaxLanes(D()) > 4) {
    const hn::Half<D> half;
    return hn::Combine(d, load_scattered(half, base, offsets + hn::MaxLanes(half)),
                       load_scattered(half, base, offsets));
  } else {
    hn::Vec<D> lanes = hn::Zero(d);
    lanes = hn::InsertLane(lanes, 0, four_bytes(base + offsets[0]));
    lanes = hn::InsertLane(lanes, 1, four_bytes(base + offsets[1]));
    lanes = hn::InsertLane(lanes, 2, four_bytes(base + offsets[2]));
    return hn::InsertLane(lanes, 3, four_bytes(base + offsets[3]));
  }
}

// Where among four bytes the samples of two neighbouring pixels stand: at kFirst and kSecond.
template <int kFirst, int kSecond>
struct Samples {
  static constexpr int kPixelBytes = kSecond - kFirst;

  // The two as a pair of 16-bit numbers.
  static HWY_INLINE V32 pair(D32 d, V32 bytes) {
    if constexpr (kSecond - kFirst == 2) {
      return hn::And(hn::ShiftRight<8 * kFirst>(bytes), hn::Set(d, 0x00ff00ff));
    } else {
      static_assert(kFirst == 0);
      const V32 second = kSecond == 1 ? hn::ShiftLeft<8>(bytes) : hn::ShiftRight<8>(bytes);
      return hn::Or(hn::And(bytes, hn::Set(d, 0xff)), hn::And(second, hn::Set(d, 0xff0000)));
    }
  }
};

using OneByte = Samples<0, 1>;
using FirstOfTwo = Samples<0, 2>;
using SecondOfTwo = Samples<1, 3>;
using ThreeBytes = Samples<0, 3>;

// (kWarpSteps - step, step), for the two neighbours that a sample lies between.
HWY_INLINE V32 weights(D32 d, V32 step) {
  return hn::Add(hn::Sub(hn::ShiftLeft<16>(step), step), hn::Set(d, kWarpSteps));
}

template <class Layout>
HWY_INLINE V32 interpolate(D32 d, V32 entry, V32 top, V32 bottom) {
  const V32 step = hn::Set(d, kWarpSteps - 1);
  const V32 across = weights(d, hn::And(entry, step));
  const V32 down = weights(d, hn::And(hn::ShiftRight<16>(entry), step));
  const V32 above = multiply_add_pairs(d, Layout::pair(d, top), across);
  const V32 below = multiply_add_pairs(d, Layout::pair(d, bottom), across);
  const V32 sum = multiply_add_pairs(d, hn::Or(above, hn::ShiftLeft<16>(below)), down);
  const V32 half = hn::Set(d, kWarpSteps / 2);
  return hn::ShiftRight<kWarpBits>(hn::Add(hn::ShiftRight<kWarpBits>(hn::Add(sum, half)), half));
}

// `base`: the byte from which the tile's entries count.
template <class Layout>
HWY_INLINE void warp_tile(const WarpEntry* entries, const std::uint8_t* base,
                          const SampledImage& image, int rows, WarpOutput out) {
  const D32 d;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(D32()));
  const hn::Rebind<std::uint8_t, D32> d8;
  const hn::RebindToSigned<D32> di32;
  const hn::Repartition<std::uint16_t, D32> d16;
  const V32 step_bytes = hn::Set(d, static_cast<std::uint32_t>(image.stride) << 16 |
                                        static_cast<std::uint32_t>(image.pixel_bytes));
  HWY_ALIGN std::uint32_t offsets[kTilePixels];
  for (int k = 0; k < kTilePixels; k += kLanes) {
    const auto whole = hn::ShiftRight<kWarpBits>(hn::BitCast(d16, hn::LoadU(d, entries + k)));
    hn::Store(multiply_add_pairs(d, hn::BitCast(d, whole), step_bytes), d, offsets + k);
  }
  for (int i = 0; i < rows; ++i, out.pixels += out.stride) {
    for (int j = 0; j < kTileColumns; j += kLanes) {
      const int k = i * kTileColumns + j;
      const V32 top = load_scattered(d, base, offsets + k);
      const V32 bottom = load_scattered(d, base + image.stride, offsets + k);
      const V32 value = interpolate<Layout>(d, hn::LoadU(d, entries + k), top, bottom);
      hn::StoreU(hn::DemoteTo(d8, hn::BitCast(di32, value)), d8, out.pixels + j);
    }
  }
}

// Whether four bytes can be read from every place that the tile's entries lead to.
HWY_INLINE bool readable(const WarpTile& tile, const SampledImage& image, std::size_t lead) {
  const std::size_t last =
      (tile.last_row + std::size_t{1}) * static_cast<std::size_t>(image.stride) +
      tile.last_column * static_cast<std::size_t>(image.pixel_bytes) + lead;
  return last + 4 <= image.bytes.size();
}

// `lead`: of a pixel's bytes, the one from which four are read.
template <class Layout>
void warp_tiles(const WarpStrip& strip, std::size_t lead) {
  const int count = strip.table.tiles_per_strip();
  const auto first = static_cast<std::size_t>(strip.strip) * static_cast<std::size_t>(count);
  const WarpTile* const tiles = strip.table.tiles().data() + first;
  const WarpEntry* const entries = strip.table.entries().data() + first * kTilePixels;
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(strip.image.bytes.data());
  for (int t = 0; t < count; ++t) {
#if HWY_TARGET <= HWY_AVX3_DL
    if constexpr (Layout::kPixelBytes <= 2) {
      const std::size_t number = first + static_cast<std::size_t>(t);
      if (!strip.windows.empty() && strip.windows.tile(number).fits) {
        warp_tile_by_windows<Layout::kPixelBytes>(strip, number, t);
        continue;
      }
    }
#endif
    if (!readable(tiles[t], strip.image, lead)) {
      warp_tile_plain(strip, t);
      continue;
    }
    const std::uint8_t* const base =
        bytes + tiles[t].row * static_cast<std::size_t>(strip.image.stride) +
        tiles[t].column * static_cast<std::size_t>(strip.image.pixel_bytes) + lead;
    warp_tile<Layout>(entries + static_cast<std::ptrdiff_t>(t) * kTilePixels, base, strip.image,
                      strip.rows,
                      {strip.out.pixels + std::ptrdiff_t{t} * kTileColumns, strip.out.stride});
  }
}

void warp_strip(const WarpStrip& strip) {
  switch (strip.image.pixel_bytes) {
    case 1:
      return warp_tiles<OneByte>(strip, static_cast<std::size_t>(strip.image.lead));
    case 2:
      return strip.image.lead == 0 ? warp_tiles<FirstOfTwo>(strip, 0)
                                   : warp_tiles<SecondOfTwo>(strip, 0);
    default:
      return warp_tiles<ThreeBytes>(strip, static_cast<std::size_t>(strip.image.lead));
  }
}

#endif  // HWY_TARGET

bool uses_windows() { return HWY_TARGET <= HWY_AVX3_DL; }

}  // namespace
}  // namespace bole::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bole {
namespace {

HWY_EXPORT(warp_strip);
HWY_EXPORT(uses_windows);

void warp_strip_plain(const WarpStrip& strip) {
  for (int tile = 0; tile < strip.table.tiles_per_strip(); ++tile) warp_tile_plain(strip, tile);
}

template <class Kernel>
void warp_with(Kernel kernel, const WarpTable& table, const WarpWindows& windows,
               const SampledImage& image, int first, int last, WarpOutput out) {
  for (int row = first; row < last; row += kTileRows) {
    const WarpStrip strip{table, windows, image, row / kTileRows, std::min(kTileRows, last - row),
                          out};
    kernel(strip);
    warp_strays(strip);
    out.pixels += static_cast<std::ptrdiff_t>(kTileRows) * out.stride;
  }
}

}  // namespace

void warp_rows_plain(const WarpTable& table, const SampledImage& image, int first, int last,
                     WarpOutput out) {
  warp_with(warp_strip_plain, table, {}, image, first, last, out);
}

bool warp_uses_windows() { return HWY_DYNAMIC_DISPATCH(uses_windows)(); }

void warp_rows(const WarpTable& table, const WarpWindows& windows, const SampledImage& image,
               int first, int last, WarpOutput out) {
  // The kernels multiply by the stride in 16 bits; wider images are rare enough to be slow.
  if (image.stride > std::numeric_limits<std::int16_t>::max()) {
    return warp_rows_plain(table, image, first, last, out);
  }
  warp_with(HWY_DYNAMIC_DISPATCH(warp_strip), table, windows, image, first, last, out);
}

}  // namespace bole
#endif  // HWY_ONCE
