#include "detect/bands.h"

#include <algorithm>
#include <cmath>

#include "detect/band_kernels.h"

namespace bole {

Bands::Bands(const DetectorSetup& setup, int margin)
    : count_(setup.panorama.rows / kRows),
      width_(setup.panorama.width),
      margin_(margin),
      pitch_(width_ + 2 * margin + 1),
      coarse_pitch_(pitch_ / kCoarse + 1),
      wraps_(setup.panorama.wraps()),
      log_(255 * kRows + 1),
      row_sum_(width_),
      sums_(static_cast<std::size_t>(count_) * pitch_ + kSpare),
      coarse_(static_cast<std::size_t>(count_) * coarse_pitch_),
      seen_(static_cast<std::size_t>(count_) * pitch_) {
  const auto log = [](int sum) {
    return std::lround(kScale * std::log(static_cast<double>(sum) / kRows + kBlackLevel));
  };
  for (int sum = 0; sum < static_cast<int>(log_.size()); ++sum)
    log_[sum] = static_cast<std::uint16_t>(log(sum) - log(0));

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
  for (int band = 0; band < count_; ++band) {
    const std::uint8_t* rows[kRows];
    for (int i = 0; i < kRows; ++i) rows[i] = panorama.row(band * kRows + i);
    sum_four_rows(rows, width_, row_sum_.data());
    std::uint16_t* sums = sums_.data() + static_cast<std::size_t>(band) * pitch_ + margin_;
    unsigned total = 0;
#pragma GCC unroll 4
    for (int x = 0; x < width_; ++x) {
      sums[x] = static_cast<std::uint16_t>(total);
      total += log_[row_sum_[x]];
    }
    sums[width_] = static_cast<std::uint16_t>(total);
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
    const std::uint16_t left = log_[row_sum_[0]], right = log_[row_sum_[width_ - 1]];
    for (int i = 0; i < margin_; ++i) {
      sums[-i - 1] = static_cast<std::uint16_t>(sums[-i] - left);
      sums[width_ + i + 1] = static_cast<std::uint16_t>(sums[width_ + i] + right);
    }
  }
}

}  // namespace bole
