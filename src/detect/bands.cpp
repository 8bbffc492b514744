#include "detect/bands.h"

#include <algorithm>
#include <cmath>

namespace bole {

Bands::Bands(const DetectorSetup& setup, int margin)
    : count_(setup.panorama.rows / kRows),
      width_(setup.panorama.width),
      margin_(margin),
      pitch_(width_ + 2 * margin + 1),
      wraps_(setup.panorama.wraps()),
      log_(255 * kRows + 1),
      row_sum_(width_),
      sums_(static_cast<std::size_t>(count_) * pitch_),
      seen_(static_cast<std::size_t>(count_) * pitch_) {
  for (int sum = 0; sum < static_cast<int>(log_.size()); ++sum)
    log_[sum] = static_cast<std::int16_t>(
        std::lround(kScale * std::log(static_cast<double>(sum) / kRows + kBlackLevel)));

  for (int band = 0; band < count_; ++band) {
    std::uint8_t* seen = seen_.data() + static_cast<std::size_t>(band) * pitch_;
    for (int i = 0; i < width_ + 2 * margin_; ++i) {
      int x = i - margin_;
      if (wraps_)
        x = ((x % width_) + width_) % width_;
      else if (x < 0 || x >= width_)
        continue;
      seen[i] = 1;
      for (int row = band * kRows; row < (band + 1) * kRows; ++row)
        seen[i] &= setup.seen.pixels[static_cast<std::size_t>(row) * width_ + x];
    }
  }
}

void Bands::compute(const PanoramaView& panorama) {
  for (int band = 0; band < count_; ++band) {
    const std::uint8_t* rows[kRows];
    for (int i = 0; i < kRows; ++i) rows[i] = panorama.row(band * kRows + i);
    for (int x = 0; x < width_; ++x)
      row_sum_[x] = static_cast<std::uint16_t>(rows[0][x] + rows[1][x] + rows[2][x] + rows[3][x]);

    std::int32_t* sums = sums_.data() + static_cast<std::size_t>(band) * pitch_;
    std::int32_t total = 0;
    int i = 0;
    const auto add = [&](int x) {
      sums[i++] = total;
      total += log_[row_sum_[x]];
    };
    if (wraps_) {
      int x = (width_ - margin_ % width_) % width_;
      for (int left = width_ + 2 * margin_; left > 0;) {
        const int run = std::min(left, width_ - x);
        for (int end = x + run; x < end; ++x) add(x);
        left -= run;
        x = 0;
      }
    } else {
      for (int x = 0; x < margin_; ++x) add(0);
      for (int x = 0; x < width_; ++x) add(x);
      for (int x = 0; x < margin_; ++x) add(width_ - 1);
    }
    sums[i] = total;
  }
}

}  // namespace bole
