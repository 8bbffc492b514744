#include "base/jpeg_decoder.h"

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <new>

// <cstdio> before it: jpeglib.h needs its types.
#include <jerror.h>
#include <jpeglib.h>

namespace bole {

/// What libjpeg works with. Where it refuses a picture it jumps, as its manual has it: so nothing
/// that needs a destructor may live in what run() is given.
struct JpegDecoder::State {
  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::jmp_buf refused{};
  char reason[JMSG_LENGTH_MAX] = {};

  State() {
    jpeg.err = jpeg_std_error(&errors);
    errors.error_exit = [](j_common_ptr common) { refuse(common); };
    errors.emit_message = [](j_common_ptr common, int level) {
      const bool warning = level < 0;
      if (warning && !is_padding(*common->err)) refuse(common);
    };
    progress.progress_monitor = [](j_common_ptr common) {
      if (of(common).jpeg.input_scan_number > kMostScans) refuse(common, "too many scans");
    };
    jpeg.client_data = this;
    if (!attempt([this] { jpeg_create_decompress(&jpeg); })) throw std::bad_alloc();
    jpeg.progress = &progress;
  }
  ~State() { jpeg_destroy_decompress(&jpeg); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  /// Throws DamagedJpeg when something is refused in `work`.
  template <typename Work>
  void run(Work work) {
    if (!attempt(work)) throw DamagedJpeg(reason);
  }

 private:
  template <typename Work>
  bool attempt(Work work) {
    if (setjmp(refused) != 0) return false;
    work();
    return true;
  }

  // A file with more of them is made to take hours.
  static constexpr int kMostScans = 500;

  static State& of(j_common_ptr common) { return *static_cast<State*>(common->client_data); }

  [[noreturn]] static void refuse(j_common_ptr common, const char* reason = nullptr) {
    State& state = of(common);
    if (reason != nullptr) {
      std::strncpy(state.reason, reason, sizeof state.reason - 1);
    } else {
      common->err->format_message(common, state.reason);
    }
    std::longjmp(state.refused, 1);
  }

  // Codes that were damaged may run out early, but then mostly leave more than these. What follows
  // the whole picture says nothing of its codes, so that more is allowed there.
  static bool is_padding(const jpeg_error_mgr& message) {
    constexpr int kMostBytes = 16, kMostBytesAtEnd = 64;
    if (message.msg_code != JWRN_EXTRANEOUS_DATA) return false;
    const int bytes = message.msg_parm.i[0], marker = message.msg_parm.i[1];
    return bytes <= (marker == JPEG_EOI ? kMostBytesAtEnd : kMostBytes);
  }
};

JpegDecoder::JpegDecoder() : state_(std::make_unique<State>()) {}

JpegDecoder::~JpegDecoder() = default;

JpegDecoder::Header JpegDecoder::read_header(std::span<const std::byte> bytes) {
  jpeg_decompress_struct& jpeg = state_->jpeg;
  state_->run([&] {
    jpeg_abort_decompress(&jpeg);  // the picture before, where it was not decoded to its end
    jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    jpeg_read_header(&jpeg, TRUE);
  });
  return {{static_cast<int>(jpeg.image_width), static_cast<int>(jpeg.image_height)},
          jpeg.jpeg_color_space == JCS_GRAYSCALE};
}

void JpegDecoder::decode(PixelFormat format, std::span<std::byte> pixels) {
  jpeg_decompress_struct& jpeg = state_->jpeg;
  state_->run([&] {
    jpeg.out_color_space = format == PixelFormat::grey ? JCS_GRAYSCALE : JCS_EXT_BGR;
    jpeg_start_decompress(&jpeg);
    const std::size_t row_bytes = pixels.size() / jpeg.output_height;
    while (jpeg.output_scanline < jpeg.output_height) {
      auto* row = reinterpret_cast<JSAMPROW>(&pixels[jpeg.output_scanline * row_bytes]);
      jpeg_read_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_decompress(&jpeg);
  });
}

}  // namespace bole
