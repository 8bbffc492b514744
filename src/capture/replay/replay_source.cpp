#include "capture/replay/replay_source.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "base/errors.h"
#include "capture/replay/image_file.h"
#include "capture/replay/media.h"

namespace bole {
namespace {

constexpr double kMinRateHz = 0.01;
constexpr double kMaxRateHz = 1000;

std::unique_ptr<ReplayMedia> open_media(const ReplayOptions& options) {
  std::error_code error;
  if (!std::filesystem::exists(options.path, error)) {
    throw ConfigError(options.path, "", "does not exist",
                      "give an image, a folder of frames or a video");
  }
  if (!std::filesystem::is_directory(options.path) &&
      !std::filesystem::is_regular_file(options.path)) {  // a pipe would be waited for
    throw ConfigError(options.path, "", "is not a regular file",
                      "give an image, a folder of frames or a video");
  }
  return is_video_name(options.path) && !std::filesystem::is_directory(options.path)
             ? open_video_file(options)
             : open_frame_files(options);
}

// Microseconds; no recording lasts longer than kMaxUtimeUs.
std::int64_t whole_us(double seconds) {
  return std::llround(std::min(seconds * 1e6, static_cast<double>(kMaxUtimeUs)));
}

class ReplaySource : public FrameSource {
 public:
  ReplaySource(const ReplayOptions& options, Clock& clock)
      : options_(options), clock_(clock), media_(open_media(options)) {
    const std::int64_t origin_us = media_->next_utime_us().value();
    start_us_ = origin_us + whole_us(options.start_s);
    end_us_ = origin_us + whole_us(options.end_s);
    const std::optional<std::int64_t> first = seek();
    if (!first) {
      throw ConfigError(options.path, "", "has no frame between start and end",
                        "give other seconds from its first frame on");
    }
    first_us_ = *first;
  }

  void open() override {
    // Nothing but stamps tells the time in lockstep, so its clock starts where they do.
    if (lockstep() && seq_ == 0) clock_.sleep_until(first_us_ * 1000, never_);
  }
  Grab grab(std::chrono::nanoseconds timeout) override;
  void close() noexcept override {}
  void interrupt() noexcept override { interrupted_.raise(); }
  std::chrono::nanoseconds frame_period() const override;
  std::string description() const override { return "replay of " + options_.path.string(); }

 private:
  // The next frame, read ahead of its time.
  struct Pending {
    std::optional<int> slot;  // of pool_; none: unreadable
    std::string error;
    std::int64_t seq = 0;
    std::int64_t utime_us = 0;
    std::int64_t release_ns = 0;
  };

  bool lockstep() const { return options_.pace.kind == ReplayPace::Kind::lockstep; }
  bool paced() const {
    return options_.pace.kind == ReplayPace::Kind::realtime ||
           options_.pace.kind == ReplayPace::Kind::rate;
  }
  std::optional<std::int64_t> seek();
  bool next_round();
  std::int64_t release_ns(std::int64_t utime_us, std::int64_t seq) const;
  void skip_overdue(DropCounts& drops);
  void read_ahead();
  void hand_out(Grab& grab);

  ReplayOptions options_;
  Clock& clock_;
  Wakeup interrupted_;
  Wakeup never_;
  std::unique_ptr<ReplayMedia> media_;
  std::shared_ptr<FramePool> pool_ = FramePool::make();

  std::int64_t start_us_ = 0;            // as recorded
  std::int64_t end_us_ = 0;              // likewise
  std::int64_t first_us_ = 0;            // of the first frame replayed, as recorded
  std::int64_t last_us_ = 0;             // the latest of this round, as recorded
  std::int64_t shift_us_ = 0;            // added to recorded stamps in this round
  std::int64_t seq_ = 0;                 // of the media's next frame
  std::optional<std::int64_t> base_ns_;  // the clock's time at which first_us_ is replayed
  std::optional<Pending> pending_;
};

// Steps past frames outside of start and end; the recorded stamp of the next one inside.
std::optional<std::int64_t> ReplaySource::seek() {
  std::optional<std::int64_t> utime_us = media_->next_utime_us();
  while (utime_us && *utime_us < start_us_) {
    media_->skip();
    utime_us = media_->next_utime_us();
  }
  return utime_us && *utime_us < end_us_ ? utime_us : std::nullopt;
}

// Back to the first frame, with time going on where the round ends. False when there is no more.
bool ReplaySource::next_round() {
  const std::int64_t length_us = last_us_ - first_us_ + media_->period_us();
  if (!options_.loop || shift_us_ > kMaxUtimeUs - length_us) return false;
  shift_us_ += length_us;
  last_us_ = first_us_;
  media_->rewind();
  return seek().has_value();
}

std::int64_t ReplaySource::release_ns(std::int64_t utime_us, std::int64_t seq) const {
  switch (options_.pace.kind) {
    case ReplayPace::Kind::realtime:
      return *base_ns_ + (utime_us - first_us_) * 1000;
    case ReplayPace::Kind::rate:
      return *base_ns_ + std::llround(1e9 * static_cast<double>(seq) / options_.pace.rate_hz);
    case ReplayPace::Kind::fast:
      return clock_.mono_ns();
    case ReplayPace::Kind::lockstep:
      return utime_us * 1000;
  }
  return 0;
}

// Whoever comes so late that the following frame is due too has missed this one.
void ReplaySource::skip_overdue(DropCounts& drops) {
  if (!paced()) return;
  const std::int64_t now_ns = clock_.mono_ns();
  while (seek()) {
    const std::optional<std::int64_t> following_us = media_->following_utime_us();
    if (!following_us || release_ns(*following_us + shift_us_, seq_ + 1) > now_ns) return;
    last_us_ = std::max(last_us_, *media_->next_utime_us());
    media_->skip();
    ++seq_;
    ++drops[DropCause::superseded];
  }
}

void ReplaySource::read_ahead() {
  const std::int64_t recorded_us = *media_->next_utime_us();
  last_us_ = std::max(last_us_, recorded_us);
  Pending next;
  next.seq = seq_++;
  next.utime_us = recorded_us + shift_us_;
  const int slot = pool_->take();
  try {
    media_->read(pool_->slot(slot));
    next.slot = slot;
  } catch (const UnreadableFrame& error) {
    pool_->give_back(slot);
    next.error = error.what();
  }
  next.release_ns = release_ns(next.utime_us, next.seq);
  pending_ = std::move(next);
}

void ReplaySource::hand_out(Grab& grab) {
  const Pending next = *std::exchange(pending_, std::nullopt);
  if (!next.slot) {
    grab.kind = Grab::Kind::bad_frame;
    ++grab.drops[DropCause::unreadable];
    grab.reason = next.error;
    return;
  }
  FrameStamp stamp{StampClock::replay, next.utime_us * 1000, next.release_ns};
  if (options_.restamp) stamp = {StampClock::monotonic, next.release_ns, next.release_ns};
  grab.kind = Grab::Kind::frame;
  grab.frame = pool_->frame(*next.slot, stamp, next.seq);
}

Grab ReplaySource::grab(std::chrono::nanoseconds timeout) {
  const std::int64_t deadline_ns = clock_.mono_ns() + timeout.count();
  if (!base_ns_) base_ns_ = clock_.mono_ns();
  Grab grab;
  if (!pending_) {
    skip_overdue(grab.drops);
    try {
      if (!seek() && !next_round()) {
        grab.kind = Grab::Kind::end;
        return grab;
      }
    } catch (const ConfigError& error) {  // the file is gone
      grab.kind = Grab::Kind::end;
      grab.reason = error.what();
      return grab;
    }
    read_ahead();
  }
  // In lockstep the clock waits for the frame, not the frame for the clock.
  const bool in_time = lockstep() || pending_->release_ns <= deadline_ns;
  if (!clock_.sleep_until(in_time ? pending_->release_ns : deadline_ns, interrupted_)) {
    interrupted_.take();
    grab.kind = Grab::Kind::interrupted;
  } else if (in_time) {
    hand_out(grab);
  }
  return grab;
}

std::chrono::nanoseconds ReplaySource::frame_period() const {
  switch (options_.pace.kind) {
    case ReplayPace::Kind::rate:
      return std::chrono::nanoseconds(std::llround(1e9 / options_.pace.rate_hz));
    case ReplayPace::Kind::fast:
      return std::chrono::nanoseconds(0);
    default:
      return std::chrono::microseconds(media_->period_us());
  }
}

void check(const ReplayOptions& options) {
  if (!(options.start_s >= 0 && options.start_s < options.end_s)) {
    throw ConfigError(options.origin, "source.start_s, source.end_s", "are no span of time",
                      "give seconds from the first frame on, start below end");
  }
  if (options.restamp && options.pace.kind == ReplayPace::Kind::lockstep) {
    throw ConfigError(options.origin, "source.restamp", "does not go with source.pace = lockstep",
                      "in lockstep the recorded stamps are the clock");
  }
}

}  // namespace

ReplayPace parse_replay_pace(std::string_view text, const std::string& origin) {
  using Kind = ReplayPace::Kind;
  if (text == "realtime") return {Kind::realtime, 0};
  if (text == "fast") return {Kind::fast, 0};
  if (text == "lockstep") return {Kind::lockstep, 0};
  constexpr std::string_view kRate = "rate:";
  if (text.starts_with(kRate)) {
    const std::string_view number = text.substr(kRate.size());
    double rate_hz = 0;
    const auto [stop, error] =
        std::from_chars(number.data(), number.data() + number.size(), rate_hz);
    if (error == std::errc() && stop == number.data() + number.size() && rate_hz >= kMinRateHz &&
        rate_hz <= kMaxRateHz) {
      return {Kind::rate, rate_hz};
    }
  }
  throw ConfigError(origin, "source.pace", "is \"" + std::string(text) + "\"",
                    "must be realtime, rate:N (0.01 to 1000 frames a second), fast or lockstep");
}

std::unique_ptr<FrameSource> make_replay_source(const ReplayOptions& options, Clock& clock) {
  check(options);
  return std::make_unique<ReplaySource>(options, clock);
}

}  // namespace bole
