#include "capture/replay/png.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <new>
#include <string>
#include <string_view>

#include "capture/replay/image_file.h"

namespace bole {
namespace {

// libpng is C: no exception may pass through it. What fails in it jumps back here instead.
class PngReader {
 public:
  explicit PngReader(std::span<const std::byte> file) : rest_(file) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, fail, warn);
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
    png_set_read_fn(png_, this, take_bytes);
  }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

  // The size; afterwards rows come as 8-bit grey or BGR.
  ImageSize read_header() {
    attempt([this] {
      png_read_info(png_, info_);
      grey_ = (png_get_color_type(png_, info_) & PNG_COLOR_MASK_COLOR) == 0;
      png_set_expand(png_);  // palettes and less than 8 bits
      png_set_strip_16(png_);
      png_set_strip_alpha(png_);
      png_set_bgr(png_);
      passes_ = png_set_interlace_handling(png_);
    });
    return {static_cast<int>(png_get_image_width(png_, info_)),
            static_cast<int>(png_get_image_height(png_, info_))};
  }
  bool grey() const { return grey_; }

  void read_rows(std::span<std::byte> pixels, ImageSize size) {
    const std::size_t row_bytes = pixels.size() / static_cast<std::size_t>(size.height);
    attempt([&, this] {
      png_start_read_image(png_);
      for (int pass = 0; pass < passes_; ++pass) {
        for (std::size_t at = 0; at < pixels.size(); at += row_bytes) {
          png_read_row(png_, reinterpret_cast<png_bytep>(&pixels[at]), nullptr);
        }
      }
      png_read_end(png_, nullptr);
    });
  }

 private:
  // The calls of libpng are left where they fail, so `calls` must own nothing.
  template <class Calls>
  void attempt(const Calls& calls) {
    if (setjmp(png_jmpbuf(png_)) != 0) {
      throw UnreadableFrame(std::string("is a damaged PNG image: ") + problem_.data());
    }
    calls();
  }

  // In place of libpng's own reports, which go to standard error.
  [[noreturn]] static void fail(png_structp png, png_const_charp message) {
    auto& problem = static_cast<PngReader*>(png_get_error_ptr(png))->problem_;
    std::snprintf(problem.data(), problem.size(), "%s", message);
    png_longjmp(png, 1);
  }
  static void warn(png_structp /*png*/, png_const_charp /*message*/) {}

  static void take_bytes(png_structp png, png_bytep into, std::size_t count) {
    auto& rest = static_cast<PngReader*>(png_get_io_ptr(png))->rest_;
    if (count > rest.size()) png_error(png, "cut short");
    std::memcpy(into, rest.data(), count);
    rest = rest.subspan(count);
  }

  std::span<const std::byte> rest_;
  std::array<char, 128> problem_{};
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  bool grey_ = false;
  int passes_ = 1;
};

}  // namespace

bool is_png(std::span<const std::byte> file) {
  constexpr std::string_view kSignature = "\x89PNG";
  return std::ranges::equal(file.first(std::min(file.size(), kSignature.size())),
                            std::as_bytes(std::span(kSignature)));
}

void decode_png(std::span<const std::byte> file, ImageSize wanted, FrameSlot& slot) {
  PngReader reader(file);
  slot.size = reader.read_header();
  check_frame_size(slot.size, wanted);
  slot.format = reader.grey() ? PixelFormat::grey : PixelFormat::bgr24;
  slot.bytes.resize(packed_frame_bytes(slot.format, slot.size));
  reader.read_rows(slot.bytes, slot.size);
}

}  // namespace bole
