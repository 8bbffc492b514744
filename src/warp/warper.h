#pragma once

#include <cstdint>
#include <vector>

#include "base/image.h"
#include "geometry/panorama_view.h"
#include "warp/luma_decoder.h"
#include "warp/warp_rows.h"
#include "warp/warp_table.h"

namespace bole {

/// Un-warps the green plane of frames, straight from the buffer and the pixel format that they came
/// in. What stands for green: of RGB and BGR green itself; of YUYV, UYVY, NV12 and MJPEG luma,
/// which is mostly green; of Bayer images green, completed as complete_bayer_green says.
///
/// The table must outlive it. Not for use by two threads at once. Allocates nothing after the first
/// frame of a format.
class Warper {
 public:
  explicit Warper(const WarpTable& table);

  const PanoramaGeometry& geometry() const { return table_.panorama(); }

  /// The panorama of `image`, in a buffer of the Warper's own, until the next call. Throws BadFrame
  /// when the image is damaged, cut short or not of the table's size.
  PanoramaView warp(const ImageView& image);

  /// For those who take the panorama row by row: checks and, where the format asks for it, decodes
  /// an image. What is returned refers to `image` or to the Warper, until the next call.
  SampledImage open(const ImageView& image);
  /// Un-warps rows [first, last) of an opened image; `first` is a multiple of kTileRows. Writes
  /// padded_width() bytes a row.
  void warp_rows(const SampledImage& image, int first, int last, WarpOutput out) const {
    bole::warp_rows(table_, windows_, image, first, last, out);
  }
  int padded_width() const { return table_.padded_width(); }

 private:
  const WarpTable& table_;
  WarpWindows windows_;
  LumaDecoder decoder_;
  std::vector<std::uint8_t> green_;
  std::vector<std::uint8_t> panorama_;
};

}  // namespace bole
