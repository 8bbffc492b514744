#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "base/errors.h"
#include "capture/replay/codecs.h"
#include "capture/replay/image_file.h"
#include "capture/replay/media.h"
#include "capture/replay/names.h"

namespace bole {
namespace {

constexpr std::int64_t kSecondUs = 1'000'000;

class VideoMedia final : public ReplayMedia {
 public:
  explicit VideoMedia(const ReplayOptions& options)
      : path_(options.path), name_(options.path.filename()), wanted_(options.size) {
    rewind();
    const double rate_hz = video_->rate_hz();
    rate_hz_ =
        std::isfinite(rate_hz) && rate_hz >= 0.01 && rate_hz <= 1000 ? rate_hz : options.rate_hz;
    try {
      check_frame_size(video_->size(), wanted_);
    } catch (const UnreadableFrame& error) {
      throw ConfigError(path_, "", error.what(), "give a video of this camera");
    }
    if (!next_utime_us()) throw ConfigError(path_, "", "has no frame that can be decoded", "");
  }

  std::optional<std::int64_t> next_utime_us() override {
    if (!stepped_) more_ = video_->step();
    stepped_ = true;
    if (!more_) return std::nullopt;
    return utime_us(index_);
  }

  std::optional<std::int64_t> following_utime_us() override { return utime_us(index_ + 1); }

  void read(FrameSlot& slot) override {
    std::string error = next_utime_us() ? video_->decode(slot) : "has ended";
    if (error.empty() && slot.size != video_->size()) error = "changes its size";
    skip();
    if (!error.empty()) throw UnreadableFrame(name_ + ": " + error);
    slot.file = name_;
  }

  void skip() override {
    next_utime_us();
    stepped_ = false;
    ++index_;
  }

  void rewind() override {
    video_ = replay_codecs().open_video(path_);
    if (!video_) {
      throw ConfigError(path_, "", "is no video that can be decoded",
                        "give a video file, an image, or a folder of frames");
    }
    stepped_ = false;
    index_ = 0;
  }

  std::int64_t period_us() const override { return utime_us(1); }

 private:
  std::int64_t utime_us(std::int64_t index) const {
    return std::llround(static_cast<double>(index * kSecondUs) / rate_hz_);
  }

  std::filesystem::path path_;
  std::string name_;
  ImageSize wanted_;
  double rate_hz_ = 0;
  std::unique_ptr<VideoReader> video_;
  std::int64_t index_ = 0;
  bool stepped_ = false;  // the reader stands on frame index_
  bool more_ = false;
};

}  // namespace

bool is_video_name(const std::filesystem::path& path) {
  constexpr std::array<std::string_view, 8> kEndings = {"avi", "m4v", "mjpeg", "mjpg",
                                                        "mkv", "mov", "mp4",   "webm"};
  return std::ranges::find(kEndings, lower_ending(path)) != kEndings.end();
}

std::unique_ptr<ReplayMedia> open_video_file(const ReplayOptions& options) {
  return std::make_unique<VideoMedia>(options);
}

}  // namespace bole
