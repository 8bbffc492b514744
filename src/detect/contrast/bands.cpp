#include "detect/contrast/bands.h"

#include <algorithm>
#include <cmath>

#include "detect/contrast/band_kernels.h"

namespace bole {
namespace {

// The running sums of log[row_sum[x]], modulo 2^16. Inlined it would work out anew for each column
// where the table begins, which is a seventh of its instructions.
[[gnu::noinline]] void add_up(const std::uint16_t* row_sum, int width, const std::uint16_t* log,
                              std::uint16_t* sums) {
  unsigned total = 0;
#pragma GCC unroll 4
  for (int x = 0; x < width; ++x) {
    sums[x] = static_cast<std::uint16_t>(total);
    total += log[row_sum[x]];
  }
  sums[width] = static_cast<std::uint16_t>(total);
}

}  // namespace

Bands::Bands(const DetectorSetup& setup, int margin)
    : count_(setup.panorama.rows / kRows),
      width_(setup.panorama.width),
      margin_(margin),
      pitch_(width_ + 2 * margin + 1),
      coarse_pitch_(pitch_ / kCoarse + 1),
      wraps_(setup.panorama.wraps()),
      seen_pixels_(setup.seen),
      log_(kThickestVeil + 255 * kRows + 1),
      row_sum_(width_),
      sums_(static_cast<std::size_t>(count_) * pitch_ + kSpare),
      coarse_(static_cast<std::size_t>(count_) * coarse_pitch_),
      seen_(static_cast<std::size_t>(count_) * pitch_) {
  const auto log = [](int sum) {
    return std::lround(kScale * std::log(static_cast<double>(sum) / kRows + kBlackLevel));
  };
  static_assert(kRows == 4, "a sum's unit is that of a veil");
  for (int sum = 0; sum <= 255 * kRows; ++sum)
    log_[kThickestVeil + sum] = static_cast<std::uint16_t>(log(sum) - log(0));

  for (int band = 0; band < count_; ++band) {
    std::uint8_t* seen = seen_.data() + static_cast<std::size_t>(band) * pitch_;
    for (int i = 0; i < width_ + 2 * margin_; ++i) {
      int x = i - margin_;
      if (wraps_) {
        x = ((x % width_) + width_) % width_;
      } else if (x < 0 || x >= width_) {
        continue;
      }
      seen[i] = 1;
      for (int row = band * kRows; row < (band + 1) * kRows; ++row) {
        seen[i] &= setup.seen.pixels[static_cast<std::size_t>(row) * width_ + x];
      }
    }
  }
}

void Bands::compute(const PanoramaView& panorama) {
  veil_ = veil_over(panorama, seen_pixels_);
  for (int band = 0; band < count_; ++band) {
    const std::uint8_t* rows[kRows];
    for (int i = 0; i < kRows; ++i) rows[i] = panorama.row(band * kRows + i);
    sum_four_rows(rows, width_, row_sum_.data());
    std::uint16_t* sums = sums_.data() + static_cast<std::size_t>(band) * pitch_ + margin_;
    add_up(row_sum_.data(), width_, logs(), sums);
    extend(sums);

    const std::uint16_t* at = sums - margin_;
    std::int32_t* coarse = coarse_.data() + static_cast<std::size_t>(band) * coarse_pitch_;
    coarse[0] = at[0];
    for (int k = 1; k * kCoarse < pitch_; ++k) {
      coarse[k] =
          coarse[k - 1] + static_cast<std::uint16_t>(at[k * kCoarse] - at[(k - 1) * kCoarse]);
    }
  }
}

// Continues a band's sums into its margins.
void Bands::extend(std::uint16_t* sums) const {
  if (wraps_) {
    const std::uint16_t turn = sums[width_];
    for (int done = 0; done < margin_; done += width_) {
      const int n = std::min(width_, margin_ - done);
      std::uint16_t* left = sums - done - n;
      shift_sums(left + width_, n, static_cast<std::uint16_t>(-turn), left);
      std::uint16_t* right = sums + width_ + 1 + done;
      shift_sums(right - width_, n, turn, right);
    }
  } else {
    const std::uint16_t left = logs()[row_sum_[0]], right = logs()[row_sum_[width_ - 1]];
    for (int i = 0; i < margin_; ++i) {
      sums[-i - 1] = static_cast<std::uint16_t>(sums[-i] - left);
      sums[width_ + i + 1] = static_cast<std::uint16_t>(sums[width_ + i] + right);
    }
  }
}

}  // namespace bole
