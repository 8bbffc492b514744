#include "service/telemetry.h"

#include <algorithm>
#include <span>

#include <spdlog/spdlog.h>

#include "base/clock.h"

namespace bole {
namespace {

constexpr std::int64_t kRateNs = 500'000'000;  // over less a rate would be noise

// A replay names each bad file; a camera with ever new words must not fill the memory.
constexpr std::size_t kMostTold = 1000;

float ms(std::int64_t ns) { return static_cast<float>(ns) / 1e6F; }

std::int8_t wire_state(CameraState state) {
  switch (state) {
    case CameraState::starting:
      return status_t::STATE_STARTING;
    case CameraState::opening:
      return status_t::STATE_OPENING;
    case CameraState::streaming:
      return status_t::STATE_STREAMING;
    case CameraState::stalled:
      return status_t::STATE_STALLED;
    case CameraState::no_camera:
      break;
  }
  return status_t::STATE_NO_CAMERA;
}

// Nearest rank of `count` sorted values.
std::int64_t quantile(std::span<const std::int64_t> sorted, double q) {
  if (sorted.empty()) return 0;
  const auto rank = static_cast<std::size_t>(q * static_cast<double>(sorted.size()));
  return sorted[std::min(rank, sorted.size() - 1)];
}

}  // namespace

Telemetry::Telemetry(std::string version, std::string camera)
    : version_(std::move(version)),
      camera_(std::move(camera)),
      start_ns_(SystemClock().mono_ns()),
      rates_taken_ns_(start_ns_) {}

void Telemetry::capture_event(const CameraEvent& event) {
  const bool streaming = event.state == CameraState::streaming;
  if (!event.repeated) {
    const auto level = streaming || event.state == CameraState::opening ? spdlog::level::info
                                                                        : spdlog::level::warn;
    spdlog::log(level, "state {}: {}{}", name(event.state), event.reason,
                event.times > 1 ? " (" + std::to_string(event.times) + " times)" : "");
  }
  const std::lock_guard lock(mutex_);
  if (event.state != event_.state) forget_frames();
  event_ = event;
  if (streaming) {
    source_ = event.reason;
  } else if (event.state != CameraState::opening) {
    last_error_ = event.reason;
  }
}

// What frames have shown holds as long as they come.
void Telemetry::forget_frames() {
  degraded_reason_.clear();
  recent_count_ = 0;
}

void Telemetry::capture_counts(const CaptureCounts& counts) {
  const std::lock_guard lock(mutex_);
  capture_ = counts;
}

void Telemetry::overwritten() {
  const std::lock_guard lock(mutex_);
  ++dropped_.overwritten;
}

void Telemetry::bad_frame(const std::string& reason) {
  const std::lock_guard lock(mutex_);
  note(reason);
}

void Telemetry::unusable(std::string_view file, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  ++dropped_.unusable;
  note((file.empty() ? "frame" : std::string(file)) + ": " + reason);
}

void Telemetry::note(const std::string& trouble) {
  last_error_ = trouble;
  if (told_.size() < kMostTold && told_.insert(trouble).second) {
    spdlog::warn("left out {}", trouble);
  }
}

void Telemetry::processed(std::int64_t latency_ns, std::int64_t trees_rejected) {
  const std::lock_guard lock(mutex_);
  recent_.at(recent_count_++ % kRecent) = latency_ns;
  ++lists_;
  latency_.add(latency_ns);
  trees_rejected_ = trees_rejected;
}

void Telemetry::vision(std::string_view reason) {
  const std::lock_guard lock(mutex_);
  if (degraded_reason_ == reason) return;
  degraded_reason_ = reason;
  if (reason.empty()) {
    spdlog::info("the camera sees well again");
  } else {
    spdlog::warn("the camera cannot see well: {}", reason);
  }
}

std::vector<counter_t> Telemetry::drops() const {
  std::vector<counter_t> drops;
  for (std::size_t cause = 0; cause < kDropCauseNames.size(); ++cause) {
    drops.push_back({std::string(kDropCauseNames.at(cause)), capture_.drops.by_cause().at(cause)});
  }
  drops.push_back({"overwritten", dropped_.overwritten});
  drops.push_back({"unusable", dropped_.unusable});
  if (trees_rejected_ > 0) drops.push_back({"trees_not_finite", trees_rejected_});
  return drops;
}

std::vector<counter_t> Telemetry::camera_events() const {
  return {{"losses", capture_.losses},
          {"stalls", capture_.stalls},
          {"restarts", capture_.restarts},
          {"failed_opens", capture_.failed_opens},
          {"settings_refused", capture_.settings_refused},
          {"stamps_corrected", capture_.stamps_corrected}};
}

status_t Telemetry::status(std::int64_t now_ns, bool stopping) {
  const std::lock_guard lock(mutex_);
  status_t status{};
  status.uptime_ns = now_ns - start_ns_;
  status.version = version_;
  status.camera = camera_;
  status.source = source_;
  status.state = wire_state(event_.state);
  const bool streaming = event_.state == CameraState::streaming;
  if (!streaming) status.state_reason = event_.reason;
  if (stopping) status.state = status_t::STATE_STOPPING;
  status.frames = capture_.frames;
  status.lists = lists_;
  status.drops = drops();
  status.camera_events = camera_events();
  status.last_error = last_error_;

  take_rates(now_ns);
  status.frame_rate = frame_rate_;
  status.list_rate = list_rate_;

  if (streaming) tell_frames(status);  // else the last ones may still be worked on
  return status;
}

void Telemetry::tell_frames(status_t& status) const {
  status.degraded = degraded_reason_.empty() ? 0 : 1;
  status.degraded_reason = degraded_reason_;

  std::array<std::int64_t, kRecent> sorted = recent_;
  const std::span<std::int64_t> values(sorted.data(), std::min(recent_count_, kRecent));
  std::ranges::sort(values);
  status.latency_p50_ms = ms(quantile(values, 0.5));
  status.latency_p99_ms = ms(quantile(values, 0.99));
  status.latency_max_ms = ms(values.empty() ? 0 : values.back());
}

void Telemetry::take_rates(std::int64_t now_ns) {
  const std::int64_t since_ns = now_ns - rates_taken_ns_;
  if (since_ns < kRateNs) return;
  const float seconds = static_cast<float>(since_ns) / 1e9F;
  frame_rate_ = static_cast<float>(capture_.frames - rated_frames_) / seconds;
  list_rate_ = static_cast<float>(lists_ - rated_lists_) / seconds;
  rates_taken_ns_ = now_ns;
  rated_frames_ = capture_.frames;
  rated_lists_ = lists_;
}

Telemetry::Summary Telemetry::summary() const {
  const std::lock_guard lock(mutex_);
  return {capture_.frames,         lists_,        drops(), latency_.quantile(0.5),
          latency_.quantile(0.99), latency_.max()};
}

}  // namespace bole
