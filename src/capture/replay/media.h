#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "capture/frame_pool.h"
#include "capture/replay/replay_source.h"

namespace bole {

/// Recorded frames, one after the other. Stamps are UTC microseconds.
class ReplayMedia {
 public:
  virtual ~ReplayMedia() = default;

  /// The next frame's stamp; nullopt at the end.
  virtual std::optional<std::int64_t> next_utime_us() = 0;
  /// The stamp of the frame after that one; nullopt when there is none.
  virtual std::optional<std::int64_t> following_utime_us() = 0;
  /// Reads the next frame and steps past it. Throws UnreadableFrame, naming the file, when it is
  /// of no use; also then it is stepped past.
  virtual void read(FrameSlot& slot) = 0;
  /// Steps past the next frame.
  virtual void skip() = 0;
  /// Goes back to the first frame.
  virtual void rewind() = 0;
  /// From one frame to the next, on average.
  virtual std::int64_t period_us() const = 0;
};

/// The largest stamp taken, the year 2100: sums of stamps stay far from overflow.
inline constexpr std::int64_t kMaxUtimeUs = 4'102'444'800'000'000;

/// A folder's frames, or one file. Throws ConfigError.
std::unique_ptr<ReplayMedia> open_frame_files(const ReplayOptions& options);
/// True when a file of that name is taken for a video.
bool is_video_name(const std::filesystem::path& path);
/// A video's frames. Throws ConfigError.
std::unique_ptr<ReplayMedia> open_video_file(const ReplayOptions& options);

}  // namespace bole
