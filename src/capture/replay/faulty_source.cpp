#include <algorithm>
#include <cmath>
#include <utility>

#include "capture/replay/faults.h"

namespace bole {
namespace {

std::int64_t to_ns(double seconds) { return std::llround(seconds * 1e9); }

// When the frame happened, on the pipeline's clock.
std::int64_t happened_ns(const Frame& frame) {
  const FrameStamp stamp = frame.stamp();
  return stamp.clock == StampClock::replay ? stamp.mono_ns : stamp.ns;
}

// A frame that is handed out several times; its buffer goes home with the last of them.
class SharedFrame : public FrameBuffers {
 public:
  explicit SharedFrame(Frame frame) : frame_(std::move(frame)) {}
  void give_back(int /*index*/) noexcept override {}
  static Frame copy(const std::shared_ptr<SharedFrame>& shared) {
    const Frame& frame = shared->frame_;
    Frame again(frame.image(), frame.stamp(), frame.sensor_seq(), shared, 0);
    again.set_file(frame.file());
    return again;
  }

 private:
  Frame frame_;
};

class FaultySource : public FrameSource {
 public:
  FaultySource(std::unique_ptr<FrameSource> inner, const std::vector<Fault>& faults, Clock& clock)
      : inner_(std::move(inner)), clock_(clock) {
    for (const Fault& fault : faults) waiting_.push_back({fault, 0});
  }

  void open() override {
    if (clock_.mono_ns() < unplugged_until_ns_) throw CaptureError("unplugged by the fault script");
    inner_->open();
  }
  Grab grab(std::chrono::nanoseconds timeout) override;
  void close() noexcept override {
    inner_->close();
    held_.reset();
    again_.reset();
  }
  void interrupt() noexcept override {
    interrupted_.raise();
    inner_->interrupt();
  }
  std::chrono::nanoseconds frame_period() const override { return inner_->frame_period(); }
  std::string description() const override { return inner_->description() + ", with faults"; }
  std::vector<std::string> refused() const override { return inner_->refused(); }
  void metered(double mean) noexcept override { inner_->metered(mean); }

 private:
  struct Waiting {
    Fault fault;
    int frames_done;  // of fault.count
  };
  struct Held {
    Frame frame;
    std::int64_t until_ns;
  };

  bool due(const Fault& fault, const Frame& frame) const;
  // Applies all that is due; nullopt: the frame is swallowed.
  std::optional<Grab> pass(Grab grab);
  // Applies one fault; true once it is over.
  bool apply(Waiting& waiting, Grab& grab, bool& swallowed);
  std::optional<Grab> kept_back(std::int64_t deadline_ns);

  std::unique_ptr<FrameSource> inner_;
  Clock& clock_;
  Wakeup interrupted_;
  std::vector<Waiting> waiting_;
  std::optional<std::int64_t> first_ns_;  // the first frame's stamp
  std::int64_t blind_until_ns_ = 0;       // frames that happen before are swallowed
  std::int64_t unplugged_until_ns_ = 0;
  std::int64_t step_ns_ = 0;
  std::optional<Held> held_;
  std::shared_ptr<SharedFrame> again_;
  int times_again_ = 0;
};

bool FaultySource::due(const Fault& fault, const Frame& frame) const {
  if (fault.frame) return frame.sensor_seq() >= *fault.frame;
  return frame.stamp().ns - *first_ns_ >= to_ns(fault.at_s);
}

bool FaultySource::apply(Waiting& waiting, Grab& grab, bool& swallowed) {
  const Fault& fault = waiting.fault;
  const bool last = ++waiting.frames_done >= fault.count;
  switch (fault.kind) {
    case Fault::Kind::drop:
      swallowed = true;
      return last;
    case Fault::Kind::corrupt:
      grab.kind = Grab::Kind::bad_frame;
      ++grab.drops[DropCause::damaged];
      grab.reason = "the fault script marks it as corrupt";
      return last;
    case Fault::Kind::late:
      held_ = Held{Frame(), happened_ns(grab.frame) + to_ns(fault.duration_s)};
      return last;
    case Fault::Kind::duplicate:
      times_again_ = fault.count;
      return true;
    case Fault::Kind::stall:
      blind_until_ns_ = happened_ns(grab.frame) + to_ns(fault.duration_s);
      swallowed = true;
      return true;
    case Fault::Kind::unplug:
      unplugged_until_ns_ = clock_.mono_ns() + to_ns(fault.duration_s);
      blind_until_ns_ = unplugged_until_ns_;
      grab.kind = Grab::Kind::lost;
      grab.reason = "unplugged by the fault script";
      return true;
    case Fault::Kind::clock_step:
      step_ns_ += to_ns(fault.step_s);
      return true;
  }
  return true;
}

std::optional<Grab> FaultySource::pass(Grab grab) {
  if (!first_ns_) first_ns_ = grab.frame.stamp().ns;
  if (happened_ns(grab.frame) < blind_until_ns_) return std::nullopt;
  bool swallowed = false;
  std::erase_if(waiting_, [&](Waiting& waiting) {
    return !swallowed && grab.kind == Grab::Kind::frame && due(waiting.fault, grab.frame) &&
           apply(waiting, grab, swallowed);
  });
  if (swallowed) return std::nullopt;
  if (grab.kind != Grab::Kind::frame) {
    grab.frame = Frame();
    held_.reset();
    times_again_ = 0;
    return grab;
  }
  FrameStamp stamp = grab.frame.stamp();
  if (stamp.clock == StampClock::replay) stamp.ns += step_ns_;
  grab.frame.set_stamp(stamp);
  if (times_again_ > 0) {
    again_ = std::make_shared<SharedFrame>(std::move(grab.frame));
    grab.frame = SharedFrame::copy(again_);
  }
  if (held_) {
    held_->frame = std::move(grab.frame);
    return std::nullopt;
  }
  return grab;
}

// What is to be handed out before the next frame is asked for.
std::optional<Grab> FaultySource::kept_back(std::int64_t deadline_ns) {
  Grab grab;
  if (held_) {
    const bool in_time = held_->until_ns <= deadline_ns;
    if (!clock_.sleep_until(std::min(held_->until_ns, deadline_ns), interrupted_)) {
      interrupted_.take();
      grab.kind = Grab::Kind::interrupted;
    } else if (in_time) {
      grab.kind = Grab::Kind::frame;
      grab.frame = std::move(held_->frame);
      held_.reset();
    }
    return grab;
  }
  if (times_again_ > 0) {
    grab.kind = Grab::Kind::frame;
    grab.frame = SharedFrame::copy(again_);
    if (--times_again_ == 0) again_.reset();
    return grab;
  }
  return std::nullopt;
}

Grab FaultySource::grab(std::chrono::nanoseconds timeout) {
  const std::int64_t deadline_ns = clock_.mono_ns() + timeout.count();
  DropCounts drops;
  while (true) {
    std::optional<Grab> result = kept_back(deadline_ns);
    if (!result) {
      const std::int64_t left_ns = std::max<std::int64_t>(deadline_ns - clock_.mono_ns(), 0);
      Grab grab = inner_->grab(std::chrono::nanoseconds(left_ns));
      drops += std::exchange(grab.drops, {});
      if (grab.kind == Grab::Kind::interrupted) interrupted_.take();
      const bool frame = grab.kind == Grab::Kind::frame;
      result = frame ? pass(std::move(grab)) : std::move(grab);
    }
    if (!result && clock_.mono_ns() >= deadline_ns) result.emplace();  // a timeout
    if (result) {
      result->drops += drops;
      return std::move(*result);
    }
  }
}

}  // namespace

std::unique_ptr<FrameSource> make_faulty_source(std::unique_ptr<FrameSource> inner,
                                                const std::vector<Fault>& faults, Clock& clock) {
  return std::make_unique<FaultySource>(std::move(inner), faults, clock);
}

}  // namespace bole
