#pragma once

#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

#include "base/clock.h"
#include "base/image.h"
#include "capture/frame_source.h"

namespace bole {

/// How fast a replay goes.
struct ReplayPace {
  enum class Kind {
    realtime,  ///< by the recorded stamps; who comes late gets the newest frame, like a camera's
    rate,      ///< likewise, but `rate_hz` frames a second whatever the stamps
    fast,      ///< each frame as soon as it is asked for
    lockstep,  ///< likewise, and the replay's clock is set to the frame's stamp
  };
  Kind kind = Kind::realtime;
  double rate_hz = 0;
};

/// "realtime", "rate:N" (0.01 to 1000 frames a second), "fast" or "lockstep". Throws ConfigError,
/// which names `origin` as the file.
ReplayPace parse_replay_pace(std::string_view text, const std::string& origin = "");

struct ReplayOptions {
  /// Where these settings stand, for messages only.
  std::string origin;
  /// A folder of images or raw frames, one image or raw frame, or a video file.
  std::filesystem::path path;
  /// What the calibration holds for: the size of raw frames, and what images must have. Zero: any
  /// size, and no raw frames.
  ImageSize size;
  /// The mask that camera.toml names: in a folder, neither it nor a file of its name is a frame.
  std::filesystem::path mask;
  ReplayPace pace;
  bool loop = false;
  double start_s = 0;  ///< seconds after the first frame's stamp; earlier frames are left out
  double end_s = std::numeric_limits<double>::infinity();  ///< likewise; this and later ones too
  bool restamp = false;  ///< stamp frames with the instant of their release, as a camera would
  double rate_hz = 10;   ///< of images without timestamps.csv
};

/// Files in place of a camera.
///
/// A folder's frames are its image files (png, jpg, jpeg, bmp, pgm, ppm, tif, tiff, webp) and raw
/// frames (an ending for each PixelFormat's name: yuyv, nv12, grey, rggb ...; tightly packed; an
/// mjpeg file in a folder is one frame as such a camera sends it, its luma read alone, while a jpg
/// is a picture in colour), in the byte order of their names; other files and folders in it do not
/// count. Stamps come from the
/// folder's `timestamps.csv` (lines `file,utime_us`, never falling in that order), else frame k is
/// at k / rate_hz from 0; a video's stamps follow from its own rate. The sensor's count counts
/// files, bad ones too.
///
/// A bad file in between is a Grab::bad_frame that names it. With `loop` the stamps go on rising
/// from round to round by the length of a round. Closing and opening again goes on where it was.
///
/// Throws ConfigError when the path, timestamps.csv or every single frame is unusable. `clock` must
/// outlive the source; give a ReplayClock for lockstep.
std::unique_ptr<FrameSource> make_replay_source(const ReplayOptions& options, Clock& clock);

}  // namespace bole
