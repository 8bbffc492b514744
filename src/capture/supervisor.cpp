#include "capture/supervisor.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace bole {
namespace {

const std::string kFirstFrame = "waiting for the first frame";

// The first time, the 10th, the 100th ...: what happens without end is told ever more seldom.
bool is_told(std::int64_t times) {
  while (times % 10 == 0) times /= 10;
  return times == 1;
}

std::string seconds(std::int64_t ns) {
  const std::int64_t tenths = (ns + 50'000'000) / 100'000'000;
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " s";
}

}  // namespace

std::string_view name(CameraState state) {
  constexpr std::array<std::string_view, 5> kNames = {"starting", "opening", "streaming", "stalled",
                                                      "no camera"};
  return kNames.at(static_cast<std::size_t>(state));
}

Supervisor::Supervisor(FrameSource& source, Clock& clock, OnEvent on_event,
                       SupervisorOptions options)
    : source_(source), clock_(clock), on_event_(std::move(on_event)), options_(options) {
  reopen_wait_ns_ = options_.reopen_min.count();
  restart_wait_ns_ = options_.restart_min.count();
}

Supervisor::~Supervisor() {
  if (open_) source_.close();
}

void Supervisor::interrupt() noexcept {
  interrupted_.raise();
  source_.interrupt();
}

Grab Supervisor::next() {
  Grab grab;
  if (interrupted_.take()) {
    grab.kind = Grab::Kind::interrupted;
    return grab;
  }
  return open_ ? stream() : open_or_wait();
}

Grab Supervisor::open_or_wait() {
  Grab grab;
  const std::int64_t now_ns = clock_.mono_ns();
  if (now_ns < next_try_ns_) {
    const std::int64_t until_ns = std::min(next_try_ns_, now_ns + options_.tick.count());
    if (!clock_.sleep_until(until_ns, interrupted_)) {
      interrupted_.take();
      grab.kind = Grab::Kind::interrupted;
    }
    return grab;
  }
  open();
  return grab;
}

void Supervisor::open() {
  // May take seconds. Later on it is told why there is no camera, until there is one.
  if (state_ == CameraState::starting) enter(CameraState::opening, kFirstFrame);
  try {
    source_.open();
  } catch (const std::runtime_error& error) {  // the camera's refusal, or the system's
    if (interrupted_.wait(0)) return;          // which next() tells
    ++counts_.failed_opens;
    wait_for_camera(error.what());
    return;
  }
  open_ = true;
  got_frame_ = false;
  last_seq_ = -1;
  unused_since_frame_ = 0;
  last_frame_ns_ = clock_.mono_ns();
  counts_.settings_refused += std::ssize(source_.refused());
  // A stalled camera that was restarted stays stalled until a frame comes.
  if (state_ != CameraState::stalled) enter(CameraState::opening, kFirstFrame);
}

void Supervisor::wait_for_camera(const std::string& reason) {
  enter(CameraState::no_camera, reason);
  next_try_ns_ = clock_.mono_ns() + reopen_wait_ns_;
  reopen_wait_ns_ = std::min(2 * reopen_wait_ns_, options_.reopen_max.count());
}

Grab Supervisor::stream() {
  Grab grab = source_.grab(options_.tick);
  account(grab);
  switch (grab.kind) {
    case Grab::Kind::frame:
      if (const std::string reason = unusable(); reason.empty()) {
        streaming();
      } else {
        check_stall(reason);
      }
      break;
    case Grab::Kind::bad_frame:
    case Grab::Kind::timeout:
      check_stall(grab.reason);
      break;
    case Grab::Kind::lost:
      close();
      ++counts_.losses;
      wait_for_camera(grab.reason);
      grab.kind = Grab::Kind::timeout;
      grab.reason.clear();
      break;
    case Grab::Kind::end:
    case Grab::Kind::interrupted:
      break;
  }
  return grab;
}

void Supervisor::account(const Grab& grab) {
  counts_.drops += grab.drops;
  counts_.stamps_corrected += grab.stamps_corrected;
  unused_since_frame_ += grab.drops.total();
  if (grab.kind != Grab::Kind::frame) return;
  ++counts_.frames;
  const std::int64_t seq = grab.frame.sensor_seq();
  std::int64_t missing = 0;
  if (last_seq_ >= 0) missing = seq - last_seq_ - 1 - unused_since_frame_;
  counts_.drops[DropCause::missing] += std::max<std::int64_t>(missing, 0);
  last_seq_ = seq;
  // Of several frames taken at once, some of those that were dropped may have come after this one.
  unused_since_frame_ = std::clamp<std::int64_t>(-missing, 0, grab.drops.total());
}

void Supervisor::streaming() {
  got_frame_ = true;
  last_frame_ns_ = clock_.mono_ns();
  if (state_ != CameraState::streaming) {
    streaming_since_ns_ = last_frame_ns_;
    enter(CameraState::streaming, source_.description());
  } else if (!told_.empty() && last_frame_ns_ - streaming_since_ns_ >= options_.settle.count()) {
    settle();
  }
}

// The outage is over. A camera that comes and goes with every other frame is still in the same one.
void Supervisor::settle() {
  const std::int64_t times = told_[{state_, reason_}];
  if (!is_told(times)) on_event_({state_, reason_, false, times});
  told_.clear();
  reopen_wait_ns_ = options_.reopen_min.count();
  restart_wait_ns_ = options_.restart_min.count();
}

void Supervisor::judged(std::string_view unusable) {
  const std::lock_guard lock(judged_mutex_);
  unusable_in_a_row_ = unusable.empty() ? 0 : unusable_in_a_row_ + 1;
  unusable_ = unusable;
}

// Why frames are of no use of late; empty when they are of use.
std::string Supervisor::unusable() const {
  const std::lock_guard lock(judged_mutex_);
  return unusable_in_a_row_ < options_.unusable_frames ? "" : unusable_;
}

std::int64_t Supervisor::stall_after_ns() const {
  const double periods_ns =
      options_.stall_periods * static_cast<double>(source_.frame_period().count());
  const std::int64_t limit_ns =
      std::max(static_cast<std::int64_t>(periods_ns), options_.stall_min.count());
  return got_frame_ ? limit_ns : std::max(limit_ns, options_.first_frame.count());
}

void Supervisor::check_stall(const std::string& bad_frame) {
  const std::int64_t silent_ns = clock_.mono_ns() - last_frame_ns_;
  const std::int64_t limit_ns = stall_after_ns();
  if (silent_ns < limit_ns) return;
  if (state_ != CameraState::stalled) {
    ++counts_.stalls;
    enter(CameraState::stalled, "no " + std::string(bad_frame.empty() ? "" : "usable ") +
                                    std::string(got_frame_ ? "frame" : "first frame") + " for " +
                                    seconds(limit_ns) +
                                    (bad_frame.empty() ? "" : ": " + bad_frame));
  }
  if (silent_ns < limit_ns + restart_wait_ns_) return;
  restart_wait_ns_ = std::min(2 * restart_wait_ns_, options_.restart_max.count());
  close();
  ++counts_.restarts;
  open();
}

void Supervisor::close() {
  source_.close();
  open_ = false;
}

void Supervisor::enter(CameraState state, const std::string& reason) {
  if (state == state_ && reason == reason_) return;
  state_ = state;
  reason_ = reason;
  const std::int64_t times = ++told_[{state, reason}];
  on_event_({state, reason, !is_told(times), times});
}

}  // namespace bole
