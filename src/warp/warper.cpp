#include "warp/warper.h"

#include "warp/bad_frame.h"
#include "warp/green_plane.h"

namespace bole {
namespace {

struct Samples {
  int pixel_bytes, lead;
};

Samples samples_of(PixelFormat format) {
  switch (format) {
    case PixelFormat::yuyv:
      return {2, 0};
    case PixelFormat::uyvy:
      return {2, 1};
    case PixelFormat::rgb24:
    case PixelFormat::bgr24:
      return {3, 1};
    default:
      return {1, 0};
  }
}

bool is_bayer(PixelFormat format) {
  return format == PixelFormat::rggb || format == PixelFormat::grbg ||
         format == PixelFormat::gbrg || format == PixelFormat::bggr;
}

// The first plane holds all rows; of the last one its packed bytes are enough.
bool holds_all_rows(const ImageView& image) {
  const int row_bytes = packed_row_bytes(image.format, image.size.width);
  const auto& [bytes, stride] = image.planes[0];
  return stride >= row_bytes &&
         bytes.size() >=
             static_cast<std::size_t>(stride) * static_cast<std::size_t>(image.size.height - 1) +
                 static_cast<std::size_t>(row_bytes);
}

}  // namespace

Warper::Warper(const WarpTable& table)
    : table_(table), windows_(warp_uses_windows() ? WarpWindows(table) : WarpWindows()) {}

SampledImage Warper::open(const ImageView& image) {
  if (image.format == PixelFormat::mjpeg) {
    const ImageView luma = decoder_.decode(image.planes[0].bytes, table_.image_size());
    return {luma.planes[0].bytes, luma.planes[0].stride, 1, 0};
  }
  if (image.size != table_.image_size()) throw BadFrame(image.size, table_.image_size());
  if (!holds_all_rows(image)) throw BadFrame("is cut short");
  if (is_bayer(image.format)) {
    complete_bayer_green(image, green_);
    return {std::as_bytes(std::span(green_)), image.size.width, 1, 0};
  }
  const Samples samples = samples_of(image.format);
  return {image.planes[0].bytes, image.planes[0].stride, samples.pixel_bytes, samples.lead};
}

PanoramaView Warper::warp(const ImageView& image) {
  const SampledImage opened = open(image);
  const int rows = geometry().rows, stride = padded_width();
  panorama_.resize(static_cast<std::size_t>(rows) * static_cast<std::size_t>(stride));
  warp_rows(opened, 0, rows, {panorama_.data(), stride});
  return {&geometry(), panorama_.data(), stride};
}

}  // namespace bole
