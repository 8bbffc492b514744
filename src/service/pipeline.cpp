#include "service/pipeline.h"

#include <poll.h>
#include <pthread.h>

#include <algorithm>
#include <array>
#include <limits>

#include <spdlog/spdlog.h>

namespace bole {
namespace {

constexpr std::int64_t kHeartbeatNs = 1'000'000'000;
constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t kBusPatienceNs = 500'000'000;  // for a bus to end when we are stopped

std::int64_t now_ns() { return SystemClock().mono_ns(); }

// Processing is the only thread that works for long. Under SCHED_FIFO, where nothing but a higher
// priority interrupts it, capture and the buses would wait for it.
void let_others_first() {
  int policy = SCHED_OTHER;
  sched_param parameters{};
  ::pthread_getschedparam(::pthread_self(), &policy, &parameters);
  if (policy != SCHED_FIFO || parameters.sched_priority == 1) return;
  --parameters.sched_priority;
  ::pthread_setschedparam(::pthread_self(), policy, &parameters);
}

}  // namespace

Pipeline::Pipeline(FrameSource& source, Clock& clock, Processor& processor, Telemetry& telemetry,
                   std::vector<std::unique_ptr<Publisher>> publishers, bool lockstep, Trace* trace)
    : source_(source),
      clock_(clock),
      processor_(processor),
      telemetry_(telemetry),
      lockstep_(lockstep),
      when_full_(lockstep ? WhenFull::wait : WhenFull::overwrite),
      trace_(trace),
      supervisor_(source, clock, [this](const CameraEvent& event) { on_camera(event); }),
      buses_(
          std::move(publishers), when_full_, [this] { attention_.raise(); }, trace) {
  source_.on_step([this] { waiting_for_camera(); });
}

Pipeline::~Pipeline() {
  supervisor_.interrupt();
  frames_.close();
  buses_.close();
  buses_.interrupt();
  for (std::thread* thread : {&capture_thread_, &process_thread_}) {
    if (thread->joinable()) thread->join();
  }
  source_.on_step({});
}

// The camera is properly being waited for. A frame that is worked on has to tell of itself.
void Pipeline::waiting_for_camera() {
  if (!processing_) service_manager_.progress();
}

void Pipeline::on_camera(const CameraEvent& event) {
  telemetry_.capture_counts(supervisor_.counts());
  telemetry_.capture_event(event);
  service_manager_.status(std::string(name(event.state)) + ": " + event.reason);
  if (event.state == CameraState::streaming) {
    const std::vector<std::string> refused = source_.refused();
    if (refused != refused_) {
      for (const std::string& line : refused) spdlog::warn("camera: {}", line);
    }
    refused_ = refused;
  }
  if (event.state == CameraState::no_camera || event.state == CameraState::stalled) {
    service_manager_.ready();
  }
  status_due_ = true;
  attention_.raise();
}

void Pipeline::capture() {
  Captured captured;
  for (bool more = true; more;) {
    Grab grab = supervisor_.next();
    telemetry_.capture_counts(supervisor_.counts());
    more = grab.kind != Grab::Kind::end && grab.kind != Grab::Kind::interrupted;
    if (grab.kind == Grab::Kind::frame) {
      captured = {std::move(grab.frame), now_ns()};
      if (frames_.put(captured, when_full_)) telemetry_.overwritten();
      captured = {};  // an overwritten frame's buffer goes home
    }
    if (!grab.reason.empty()) telemetry_.bad_frame(grab.reason);
    const bool waiting =
        supervisor_.state() != CameraState::streaming || grab.kind == Grab::Kind::timeout;
    if (waiting) waiting_for_camera();
  }
  frames_.close();
}

void Pipeline::process() {
  let_others_first();
  Captured captured;
  while (frames_.take(captured)) {
    processing_ = true;
    try {
      process(captured);
      supervisor_.judged("");
    } catch (const std::exception& error) {
      telemetry_.unusable(captured.frame.file(), error.what());
      supervisor_.judged(error.what());
    }
    captured = {};
    processing_ = false;
    service_manager_.progress();
    service_manager_.ready();
  }
  processed_all_ = true;
  attention_.raise();
}

void Pipeline::process(const Captured& captured) {
  const Processor::Result result = processor_.process(captured.frame);
  const std::int64_t done_ns = result.steps_ns.back();
  buses_.offer(MessageKind::trees, result.bytes, captured.frame.file(), done_ns, result.seq);
  // In lockstep the stamps are the replay's; what passes on the computer's own clock is told.
  const std::int64_t latency_ns =
      lockstep_ ? done_ns - captured.taken_ns : result.publish_mono_ns - result.captured.mono_ns;
  telemetry_.vision(name(result.vision));
  source_.metered(result.brightness);
  telemetry_.processed(latency_ns, processor_.trees_rejected());
  if (trace_ != nullptr) trace(captured, result);
}

void Pipeline::trace(const Captured& captured, const Processor::Result& result) {
  constexpr std::array kSteps = {"warp", "detect", "judge vision", "track", "encode"};
  using Lane = Trace::Lane;
  if (!lockstep_) {
    trace_->record("driver", Lane::capture, result.seq, result.captured.mono_ns, captured.taken_ns);
  }
  trace_->record("wait for processing", Lane::capture, result.seq, captured.taken_ns,
                 result.steps_ns.front());
  for (std::size_t step = 0; step < kSteps.size(); ++step) {
    trace_->record(kSteps.at(step), Lane::processing, result.seq, result.steps_ns.at(step),
                   result.steps_ns.at(step + 1));
  }
}

void Pipeline::publish_status(bool stopping) {
  buses_.offer(telemetry_.status(now_ns(), stopping), clock_);
}

void Pipeline::run(int stop_fd) {
  capture_thread_ = std::thread([this] { capture(); });
  process_thread_ = std::thread([this] { process(); });
  std::int64_t next_beat_ns = 0;
  std::int64_t give_up_ns = kNever;
  bool closing = false;
  while (!(processed_all_ && buses_.finished()) && now_ns() < give_up_ns) {
    if (processed_all_ && !closing) {
      closing = true;
      publish_status(true);
      buses_.close();
    }
    if (!closing && (status_due_.exchange(false) || now_ns() >= next_beat_ns)) {
      publish_status(false);
      next_beat_ns = now_ns() + kHeartbeatNs;
    }
    const std::int64_t until_ns = closing ? give_up_ns : std::min(next_beat_ns, give_up_ns);
    const bool stopping = give_up_ns != kNever;
    const bool told = wait(stopping ? -1 : stop_fd, until_ns);
    if (told || (!stopping && buses_.gone())) {
      service_manager_.stopping();
      supervisor_.interrupt();
      give_up_ns = now_ns() + kBusPatienceNs;
    }
  }
}

bool Pipeline::wait(int stop_fd, std::int64_t until_ns) {
  const std::int64_t wait_ms =
      std::clamp<std::int64_t>((until_ns - now_ns()) / 1'000'000 + 1, 0, 1000);
  std::array<pollfd, 2> waits{pollfd{stop_fd, POLLIN, 0}, pollfd{attention_.fd(), POLLIN, 0}};
  ::poll(waits.data(), waits.size(), static_cast<int>(wait_ms));
  attention_.take();
  return waits[0].revents != 0;
}

}  // namespace bole
