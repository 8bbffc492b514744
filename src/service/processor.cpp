#include "service/processor.h"

#include <algorithm>

namespace bole {

Processor::Processor(const WarpTable& table, double camera_height, const Search& search,
                     ProcessorOptions options, const Clock& clock)
    : warper_(table),
      detector_(
          make_detector(options.mode, {table.panorama(), table.seen(), camera_height, search})),
      vision_(table.panorama(), table.seen()),
      options_(std::move(options)),
      search_(search),
      sharpened_(options_.track && options_.mode == DetectorMode::bole),
      clock_(clock),
      tracker_(sharpened_ ? Tracker::Scores::probabilities : Tracker::Scores::ranks) {
  list_.camera = options_.camera;
  list_.config_crc = options_.config_crc;
  list_.source = options_.source;
  list_.seq = -1;
  trees_.reserve(256);
}

void Processor::choose(std::span<const Tree> found) {
  trees_.assign(found.begin(), found.end());
  // Else the history of each decides: see track.
  if (!sharpened_) leave_out_improbable();
  if (options_.track) trees_.resize(std::min(trees_.size(), Tracker::kMostTrees));
}

void Processor::leave_out_improbable() {
  std::erase_if(trees_, [this](const Tree& tree) {
    return tree.score < static_cast<float>(options_.min_score);
  });
}

// Seconds since the last frame, as the camera saw them pass.
double Processor::step_to(std::int64_t scene_ns) {
  const double elapsed = static_cast<double>(scene_ns - last_scene_ns_.value_or(scene_ns)) / 1e9;
  last_scene_ns_ = scene_ns;
  return elapsed;
}

std::span<const Tree> Processor::detect(const PanoramaView& panorama, double elapsed) {
  return options_.track ? detector_->detect(panorama, tracker_.expected(elapsed))
                        : detector_->detect(panorama);
}

void Processor::track(double elapsed) {
  tracker_.update(trees_, elapsed);
  leave_out_improbable();
  leave_out_far();
}

// What the way shows to stand farther off than is searched.
void Processor::leave_out_far() {
  constexpr double kBeyond = 1.1;  // that a list may reach beyond the search
  std::erase_if(trees_,
                [this](const Tree& tree) { return tree.range > kBeyond * search_.range.high; });
}

Processor::Result Processor::process(const Frame& frame) {
  Result result;
  std::size_t step = 0;
  const auto stepped = [&] { result.steps_ns.at(step++) = SystemClock().mono_ns(); };

  stepped();
  const PanoramaView panorama = warper_.warp(frame.image());
  stepped();
  result.captured = frame_time(frame.stamp(), clock_);
  const double elapsed = step_to(result.captured.scene_ns);
  choose(detect(panorama, elapsed));
  stepped();
  result.vision = vision_.observe(panorama);
  result.brightness = vision_.statistics().mean;
  stepped();
  if (options_.track) track(elapsed);
  stepped();

  list_.utime = result.captured.utc_us;
  list_.capture_mono_ns = result.captured.mono_ns;
  list_.publish_mono_ns = options_.lockstep ? result.captured.mono_ns : clock_.mono_ns();
  result.seq = ++list_.seq;
  list_.sensor_seq = frame.sensor_seq();
  list_.degraded = result.vision != VisionHealth::Reason::none;
  list_.trees = trees_;
  result.publish_mono_ns = list_.publish_mono_ns;
  result.bytes = encoder_.encode(list_);
  stepped();
  return result;
}

}  // namespace bole
