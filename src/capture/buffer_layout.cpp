#include "capture/buffer_layout.h"

#include <algorithm>

namespace bole {

std::optional<ImageView> view_buffer(const BufferLayout& layout,
                                     std::span<const std::span<const std::byte>> areas) {
  ImageView view{layout.pixels, layout.size, {}};
  if (layout.pixels == PixelFormat::mjpeg) {
    if (areas[0].empty()) return std::nullopt;
    view.planes[0] = {areas[0], 0};
    return view;
  }
  const auto row = static_cast<std::size_t>(packed_row_bytes(layout.pixels, layout.size.width));
  const auto cut = [&](std::span<const std::byte> bytes, int stride, int rows) -> Plane {
    const std::size_t least = static_cast<std::size_t>(stride) * static_cast<std::size_t>(rows - 1);
    if (bytes.size() < least + row) return {};
    return {bytes.first(std::min(bytes.size(), least + static_cast<std::size_t>(stride))), stride};
  };
  view.planes[0] = cut(areas[0], layout.strides[0], layout.size.height);
  if (view.planes[0].stride == 0) return std::nullopt;
  if (layout.pixels == PixelFormat::nv12) {
    const std::span<const std::byte> chroma =
        layout.memory_planes > 1 ? areas[1] : areas[0].subspan(view.planes[0].bytes.size());
    view.planes[1] = cut(chroma, layout.strides[1], layout.size.height / 2);
    if (view.planes[1].stride == 0) return std::nullopt;
  }
  return view;
}

}  // namespace bole
