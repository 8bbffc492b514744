#include "capture/replay/image_file.h"

#include <string>
#include <string_view>

#include "base/errors.h"
#include "base/files.h"
#include "capture/replay/codecs.h"
#include "capture/replay/jpeg.h"

namespace bole {
namespace {

std::string shown(ImageSize size) {
  return std::to_string(size.width) + " x " + std::to_string(size.height);
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
