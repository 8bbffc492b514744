#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>

#include "base/errors.h"
#include "capture/replay/frame_file.h"
#include "capture/replay/frame_names.h"
#include "capture/replay/media.h"
#include "capture/replay/timestamps.h"

namespace bole {
namespace {

namespace fs = std::filesystem;

struct FrameFile {
  fs::path path;
  std::string name;
  std::int64_t utime_us = 0;
};

FrameFile frame_file(const fs::path& path) { return {path, path.filename().string()}; }

std::vector<FrameFile> list_folder(const ReplayOptions& options) {
  std::vector<FrameFile> files;
  std::ranges::transform(frames_in(options.path, options.mask), std::back_inserter(files),
                         frame_file);
  return files;
}

void stamp_by_rate(std::vector<FrameFile>& files, double rate_hz) {
  double index = 0;
  for (FrameFile& file : files) file.utime_us = std::llround(1e6 * index++ / rate_hz);
}

void stamp_by_table(std::vector<FrameFile>& files, const fs::path& table) {
  const std::map<std::string, std::int64_t> stamps = read_timestamps(table);
  for (FrameFile& file : files) {
    const auto found = stamps.find(file.name);
    if (found == stamps.end()) {
      throw ConfigError(table, "", file.name + " is missing", "give every frame a line");
    }
    file.utime_us = found->second;
  }
  const auto falls =
      std::ranges::adjacent_find(files, std::ranges::greater(), &FrameFile::utime_us);
  if (falls == files.end()) return;
  throw ConfigError(table, "", std::next(falls)->name + " is earlier than " + falls->name,
                    "times must rise in the byte order of the names; fill up their numbers with "
                    "zeros, or mend the times");
}

class FileMedia : public ReplayMedia {
 public:
  FileMedia(std::vector<FrameFile> files, const ReplayOptions& options)
      : files_(std::move(files)), reader_(options.size) {
    const std::int64_t span_us = files_.back().utime_us - files_.front().utime_us;
    period_us_ =
        span_us > 0 ? span_us / (std::ssize(files_) - 1) : std::llround(1e6 / options.rate_hz);
  }

  // Refuses files of which not one is a frame, telling what ails the first.
  void check() {
    FrameSlot slot;
    std::string first_error;
    while (next_ < files_.size()) {
      try {
        read(slot);
        rewind();
        return;
      } catch (const UnreadableFrame& error) {
        if (first_error.empty()) first_error = error.what();
      }
    }
    throw ConfigError(files_.front().path.parent_path(), "", first_error,
                      files_.size() > 1 ? "so it is with every frame here" : "");
  }

  std::optional<std::int64_t> next_utime_us() override { return utime_us(next_); }
  std::optional<std::int64_t> following_utime_us() override { return utime_us(next_ + 1); }

  void read(FrameSlot& slot) override {
    const FrameFile& file = files_.at(next_++);
    try {
      reader_.read(file.path, slot);
    } catch (const UnreadableFrame& error) {
      throw UnreadableFrame(file.name + ": " + error.what());
    }
    slot.file = file.name;
  }

  void skip() override { ++next_; }
  void rewind() override { next_ = 0; }
  std::int64_t period_us() const override { return period_us_; }

 private:
  std::optional<std::int64_t> utime_us(std::size_t index) const {
    if (index >= files_.size()) return std::nullopt;
    return files_[index].utime_us;
  }

  std::vector<FrameFile> files_;
  FrameReader reader_;
  std::int64_t period_us_ = 0;
  std::size_t next_ = 0;
};

std::vector<FrameFile> list_files(const ReplayOptions& options) {
  if (!fs::is_directory(options.path)) {
    if (!is_frame_name(options.path)) {
      throw ConfigError(options.path, "", "is no image, raw frame or video by its name's ending",
                        "give an image (png, jpg ...), a raw frame (yuyv, nv12, grey ...) or a "
                        "video (mp4, avi ...)");
    }
    return {frame_file(options.path)};
  }
  std::vector<FrameFile> files = list_folder(options);
  const fs::path table = options.path / "timestamps.csv";
  if (fs::exists(table)) {
    stamp_by_table(files, table);
  } else {
    stamp_by_rate(files, options.rate_hz);
  }
  return files;
}

}  // namespace

std::unique_ptr<ReplayMedia> open_frame_files(const ReplayOptions& options) {
  auto media = std::make_unique<FileMedia>(list_files(options), options);
  media->check();
  return media;
}

}  // namespace bole
