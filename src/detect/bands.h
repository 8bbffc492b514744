#pragma once

#include <cstdint>
#include <vector>

#include "detect/detector.h"

namespace bole {

/// The logarithm of a panorama's brightness in bands of four rows, with running sums along each
/// band: what all templates and features read. In the logarithm a contrast does not depend on how
/// much light falls on it.
///
/// Columns run beyond the panorama by `margin` on either side, continued round the turn, or by the
/// border's value where the camera sees less than a turn.
class Bands {
 public:
  static constexpr int kRows = 4;     ///< rows a band
  static constexpr int kScale = 256;  ///< units of log brightness in 1
  static constexpr int kBlackLevel =
      8;  ///< grey levels added before the logarithm: noise counts less

  /// `margin` columns are kept beyond either border.
  Bands(const DetectorSetup& setup, int margin);

  void compute(const PanoramaView& panorama);

  int count() const { return count_; }
  int width() const { return width_; }
  int margin() const { return margin_; }
  std::ptrdiff_t pitch() const { return pitch_; }  ///< from a band's sums to the next's

  /// sum(b)[x] = the sum of the log brightness over columns [-margin, x) of band b, for x in
  /// [-margin, width + margin].
  const std::int32_t* sum(int band) const {
    return sums_.data() + static_cast<std::size_t>(band) * pitch_ + margin_;
  }
  /// 1 where every row of the band is seen in this column, for x in [-margin, width + margin).
  const std::uint8_t* seen(int band) const {
    return seen_.data() + static_cast<std::size_t>(band) * pitch_ + margin_;
  }

 private:
  int count_, width_, margin_, pitch_;
  bool wraps_;
  std::vector<std::int16_t> log_;       // of a sum of kRows pixels
  std::vector<std::uint16_t> row_sum_;  // one band
  std::vector<std::int32_t> sums_;      // count x pitch
  std::vector<std::uint8_t> seen_;      // count x pitch
};

}  // namespace bole
