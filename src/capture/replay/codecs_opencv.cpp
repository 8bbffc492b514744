// The plug-in bole_replay_codecs.so: OpenCV's decoders behind ReplayCodecs.
#include <cstring>
#include <exception>

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

#include "capture/plugin.h"
#include "capture/replay/codecs.h"

namespace bole {
namespace {

// Copies 8-bit grey or BGR pixels; returns what is wrong with them.
std::string fill(const cv::Mat& image, FrameSlot& slot) {
  if (image.empty()) return "is no image that can be decoded";
  if (image.type() != CV_8UC1 && image.type() != CV_8UC3) return "has an unusual pixel type";
  slot.format = image.channels() == 1 ? PixelFormat::grey : PixelFormat::bgr24;
  slot.size = {image.cols, image.rows};
  const std::size_t row_bytes = static_cast<std::size_t>(image.cols) * image.elemSize();
  slot.bytes.resize(row_bytes * static_cast<std::size_t>(image.rows));
  for (int row = 0; row < image.rows; ++row) {
    std::memcpy(slot.bytes.data() + static_cast<std::size_t>(row) * row_bytes, image.ptr(row),
                row_bytes);
  }
  return "";
}

// Runs `decode`, which returns what is wrong, and turns what it throws into the same.
template <class Decode>
std::string guarded(Decode decode) {
  try {
    return decode();
  } catch (const cv::Exception& error) {
    return "cannot be decoded: " + error.err;
  } catch (const std::exception& error) {
    return std::string("cannot be decoded: ") + error.what();
  }
}

class OpencvVideo : public VideoReader {
 public:
  explicit OpencvVideo(const std::string& path) : capture_(path, cv::CAP_FFMPEG) {}

  bool is_open() const { return capture_.isOpened(); }
  ImageSize size() const override {
    return {static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_WIDTH)),
            static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_HEIGHT))};
  }
  double rate_hz() const override { return capture_.get(cv::CAP_PROP_FPS); }
  bool step() override { return capture_.grab(); }
  std::string decode(FrameSlot& slot) override {
    return guarded([&]() -> std::string {
      if (!capture_.retrieve(image_)) return "has a frame that cannot be decoded";
      return fill(image_, slot);
    });
  }

 private:
  cv::VideoCapture capture_;
  cv::Mat image_;
};

class OpencvCodecs : public ReplayCodecs {
 public:
  OpencvCodecs() { cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT); }

  std::string decode_image(std::span<const std::byte> file, FrameSlot& slot) const override {
    return guarded([&] {
      const cv::Mat bytes(1, static_cast<int>(file.size()), CV_8UC1,
                          const_cast<std::byte*>(file.data()));
      return fill(cv::imdecode(bytes, cv::IMREAD_ANYCOLOR | cv::IMREAD_IGNORE_ORIENTATION), slot);
    });
  }

  std::unique_ptr<VideoReader> open_video(const std::filesystem::path& path) const override {
    auto video = std::make_unique<OpencvVideo>(path.string());
    if (!video->is_open()) return nullptr;
    return video;
  }
};

}  // namespace
}  // namespace bole

BOLE_PLUGIN;

extern "C" __attribute__((visibility("default"))) const bole::ReplayCodecs& bole_replay_codecs() {
  static const bole::OpencvCodecs codecs;
  return codecs;
}
