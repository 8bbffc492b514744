#include "capture/replay/image_file.h"

#include <algorithm>
#include <span>
#include <string>
#include <string_view>

#include "base/errors.h"
#include "base/files.h"
#include "capture/replay/codecs.h"
#include "capture/replay/jpeg.h"
#include "capture/replay/png.h"

namespace bole {
namespace {

// True when `file` begins as a kind of image does that OpenCV decodes for us. It would hand
// anything else on to every reader it was built with, down to those of maps and satellite pictures.
bool is_known_image(std::span<const std::byte> file) {
  const std::string_view head(reinterpret_cast<const char*>(file.data()),
                              std::min<std::size_t>(file.size(), 12));
  const bool webp = head.starts_with("RIFF") && head.ends_with("WEBP");
  const bool netpbm = head.size() > 2 && head[0] == 'P' && head[1] >= '1' && head[1] <= '6';
  return webp || netpbm || head.starts_with("BM") ||
         head.starts_with(std::string_view("II*\0", 4)) ||
         head.starts_with(std::string_view("MM\0*", 4));
}

}  // namespace

void check_frame_size(ImageSize size, ImageSize wanted) {
  if (size.width <= 0 || size.height <= 0 ||
      std::int64_t{size.width} * size.height > kMaxImagePixels) {
    throw UnreadableFrame("has " + shown(size) + " pixels");
  }
  if (wanted.width > 0 && size != wanted) {
    throw UnreadableFrame("has " + shown(size) + " pixels; the calibration is for " +
                          shown(wanted));
  }
}

void read_frame_file(const std::filesystem::path& path, std::vector<std::byte>& bytes) {
  try {
    read_file(path, kMaxImageFileBytes, bytes);
  } catch (const ConfigError& error) {
    const std::string_view reason = error.what();
    throw UnreadableFrame(std::string(reason.substr(path.native().size() + 2)));  // "path: reason"
  }
  if (bytes.empty()) throw UnreadableFrame("is empty");
}

void ImageReader::read(const std::filesystem::path& path, FrameSlot& slot) {
  read_frame_file(path, file_);
  if (is_jpeg(file_)) {
    decode_jpeg(file_, wanted_, slot);
    return;
  }
  if (is_png(file_)) {
    decode_png(file_, wanted_, slot);
    return;
  }
  if (!is_known_image(file_)) throw UnreadableFrame("is no image");
  std::string problem;
  try {
    problem = replay_codecs().decode_image(file_, slot);
  } catch (const ConfigError& error) {
    problem = error.what();
  }
  if (!problem.empty()) throw UnreadableFrame(problem);
  check_frame_size(slot.size, wanted_);
}

}  // namespace bole
