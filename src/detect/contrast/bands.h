#pragma once

#include <cstdint>
#include <vector>

#include "detect/contrast/veil.h"
#include "detect/detector.h"

namespace bole {

/// The logarithm of a panorama's brightness, above black and any veil, in bands of four rows, with
/// running sums along each band: what all templates and features read. In the logarithm a contrast
/// does not depend on how much light falls on it.
///
/// Columns run beyond the panorama by `margin` on either side, continued round the turn, or by the
/// border's value where the camera sees less than a turn.
///
/// The sums are kept modulo 2^16, half the memory and half the vectors: what is formed of them is
/// exact while it stays below 2^16, as the sum over kMostColumns columns does, or within 2^15, as
/// the difference of two neighbouring sums over kMostFlank columns does.
class Bands {
 public:
  static constexpr int kRows = 4;     ///< rows a band
  static constexpr int kScale = 256;  ///< units of log brightness in 1
  static constexpr int kBlackLevel =
      8;  ///< grey levels added before the logarithm: noise counts less
  /// Of log brightness: what differs less is shown to the networks as no stronger than that.
  static constexpr float kLeastSpread = 0.06F;
  static constexpr int kMostLog = 894;  ///< kScale log((255 + kBlackLevel) / kBlackLevel)
  static constexpr int kMostColumns = 73;
  static constexpr int kMostFlank = 36;
  static_assert(kMostColumns * kMostLog < 1 << 16 && kMostFlank * kMostLog < 1 << 15);
  static constexpr int kCoarse = 32;  ///< columns between the whole sums
  static constexpr int kSpare = 128;  ///< sums that may be read beyond the last band's

  /// `margin` columns are kept beyond either border.
  Bands(const DetectorSetup& setup, int margin);

  void compute(const PanoramaView& panorama);

  /// Over the latest panorama, quarters of a grey level: see veil_over.
  int veil() const { return veil_; }

  int count() const { return count_; }
  int width() const { return width_; }
  int margin() const { return margin_; }
  std::ptrdiff_t pitch() const { return pitch_; }  ///< from a band's sums to the next's

  /// sum(b)[x] - sum(b)[y] = the sum of the log brightness over columns [y, x) of band b, modulo
  /// 2^16; for x in [-margin, width + margin].
  const std::uint16_t* sum(int band) const {
    return sums_.data() + static_cast<std::size_t>(band) * pitch_ + margin_;
  }
  std::ptrdiff_t coarse_pitch() const { return coarse_pitch_; }
  /// coarse(b)[k] = sum(b)[k kCoarse - margin], but not modulo 2^16.
  const std::int32_t* coarse(int band) const {
    return coarse_.data() + static_cast<std::size_t>(band) * coarse_pitch_;
  }
  /// 1 where every row of the band is seen in this column, for x in [-margin, width + margin).
  const std::uint8_t* seen(int band) const {
    return seen_.data() + static_cast<std::size_t>(band) * pitch_ + margin_;
  }

 private:
  void extend(std::uint16_t* sums) const;
  // By the sum of kRows pixels.
  const std::uint16_t* logs() const { return log_.data() + kThickestVeil - veil_; }

  int count_, width_, margin_, pitch_, coarse_pitch_;
  bool wraps_;
  SeenMap seen_pixels_;
  int veil_ = 0;
  std::vector<std::uint16_t> log_;      // of a sum of kRows pixels, from -kThickestVeil on
  std::vector<std::uint16_t> row_sum_;  // one band
  std::vector<std::uint16_t> sums_;     // count x pitch
  std::vector<std::int32_t> coarse_;    // count x coarse_pitch
  std::vector<std::uint8_t> seen_;      // count x pitch
};

}  // namespace bole
