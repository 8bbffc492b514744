#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "detect/detector.h"
#include "detect/tracking/tracker.h"
#include "detect/vision_health.h"
#include "publish/encoder.h"
#include "service/frame_time.h"
#include "warp/warp_table.h"
#include "warp/warper.h"

namespace bole {

/// What of the configuration decides what a list holds.
struct ProcessorOptions {
  DetectorMode mode = DetectorMode::bole;
  bool track = true;
  double min_score = 0.5;  ///< trees below are not published
  std::string camera;      ///< name in the lists
  std::uint32_t config_crc = 0;
  ListSource source = ListSource::replay;
  bool lockstep = false;  ///< stamp lists with the capture time in place of now
};

/// One frame in, the bytes of its list out: un-warps, detects, tracks and encodes. Used by one
/// thread; allocates nothing after the first frames.
class Processor {
 public:
  /// `table` and `clock` must outlive it.
  Processor(const WarpTable& table, double camera_height, const Search& search,
            ProcessorOptions options, const Clock& clock);

  struct Result {
    std::span<const std::byte> bytes;  ///< of the list, until the next call
    FrameTime captured;
    std::int64_t publish_mono_ns = 0;
    VisionHealth::Reason vision = VisionHealth::Reason::none;  ///< why the camera cannot see well
    float brightness = 0;  ///< mean of the panorama's seen pixels, 0 to 255
    std::int64_t seq = 0;
    /// CLOCK_MONOTONIC before the first step and after each: un-warped, detected, judged, tracked,
    /// encoded.
    std::array<std::int64_t, 6> steps_ns{};
  };
  /// Throws BadFrame when the frame cannot be used; it then takes no number in `seq`.
  Result process(const Frame& frame);

  std::int64_t trees_rejected() const { return encoder_.rejected(); }

 private:
  double step_to(std::int64_t scene_ns);
  std::span<const Tree> detect(const PanoramaView& panorama, double elapsed);
  void choose(std::span<const Tree> found);
  void leave_out_improbable();
  void leave_out_far();
  void track(double elapsed);

  Warper warper_;
  std::unique_ptr<Detector> detector_;
  VisionHealth vision_;
  TreeListEncoder encoder_;
  const ProcessorOptions options_;
  const Search search_;
  const bool sharpened_;  // scores by tracking
  const Clock& clock_;
  TreeList list_;
  std::vector<Tree> trees_;
  Tracker tracker_;
  std::optional<std::int64_t> last_scene_ns_;
};

}  // namespace bole
