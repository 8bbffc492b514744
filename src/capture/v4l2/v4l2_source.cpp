#include "capture/v4l2/v4l2_source.h"

#include <poll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <utility>

#include "base/errors.h"
#include "base/wakeup.h"
#include "capture/sequence_count.h"
#include "capture/v4l2/controls.h"
#include "capture/v4l2/stamp.h"
#include "capture/v4l2/stream.h"

namespace bole {
namespace {

class V4l2Source final : public FrameSource {
 public:
  V4l2Source(std::string device, CameraSettings settings, const Clock& clock)
      : name_(std::move(device)), settings_(settings), clock_(clock) {}
  V4l2Source(const V4l2Source&) = delete;
  V4l2Source& operator=(const V4l2Source&) = delete;
  ~V4l2Source() override { close(); }

  void open() override;
  Grab grab(std::chrono::nanoseconds timeout) override;
  void close() noexcept override {
    if (buffers_) buffers_->stop();
    buffers_.reset();
    metering_.stop();
  }
  void interrupt() noexcept override { interrupted_.raise(); }
  std::chrono::nanoseconds frame_period() const override { return format_.period; }
  std::string description() const override { return description_; }
  std::vector<std::string> refused() const override { return refused_; }
  void metered(double mean) noexcept override { metering_.tell(mean); }

 private:
  void start();
  void describe(const v4l2_capability& capability);
  short wait(std::int64_t timeout_ns) const;
  void drain(Grab& grab);
  void take(const v4l2_buffer& buffer, const ImageView& image, Grab& grab);
  void refuse(const v4l2_buffer& buffer, DropCause cause, std::string reason, Grab& grab);

  const std::string name_;
  const CameraSettings settings_;
  const Clock& clock_;
  Wakeup interrupted_;

  V4l2Format format_;
  std::shared_ptr<V4l2Buffers> buffers_;
  SequenceCount sequence_;
  Metering metering_;
  std::string description_;
  std::vector<std::string> refused_;
};

void V4l2Source::open() {
  try {
    start();
  } catch (const CaptureError& error) {
    throw CaptureError(trouble_of(name_, error.what()));
  }
}

void V4l2Source::start() {
  V4l2Device device(find_v4l2_device(name_), [this] { step(interrupted_); });
  const v4l2_capability capability = device.capability();
  format_ = negotiate_format(device, settings_);
  refused_ = apply_controls(device, settings_);
  std::string unmetered = metering_.start(settings_, exposure_range(device));
  if (!unmetered.empty()) refused_.push_back(std::move(unmetered));
  metering_.hold_below(format_.period);
  sequence_ = {};
  buffers_ = std::make_shared<V4l2Buffers>(std::move(device), format_, settings_.buffers);
  describe(capability);
}

void V4l2Source::describe(const v4l2_capability& capability) {
  std::string rate = "an unknown rate";
  if (format_.period.count() > 0) {
    const auto millihertz = std::llround(1e12 / static_cast<double>(format_.period.count()));
    const std::string thousandths = std::to_string(1000 + millihertz % 1000).substr(1);
    rate = std::to_string(millihertz / 1000) + (millihertz % 1000 == 0 ? "" : "." + thousandths) +
           " Hz";
  }
  description_ = fourcc_text(format_.fourcc) + " " + shown(format_.layout.size) + " at " + rate +
                 ", " + std::to_string(buffers_->count()) + " buffers, " +
                 reinterpret_cast<const char*>(capability.card) + in_brackets(name_);
}

// What poll() tells of the camera; POLLNVAL stands for an interruption, 0 for a timeout.
short V4l2Source::wait(std::int64_t timeout_ns) const {
  constexpr std::int64_t kSecond = 1'000'000'000;
  timeout_ns = std::max<std::int64_t>(timeout_ns, 0);
  const timespec timeout{timeout_ns / kSecond, timeout_ns % kSecond};
  std::array<pollfd, 2> events{pollfd{buffers_->fd(), POLLIN, 0},
                               pollfd{interrupted_.fd(), POLLIN, 0}};
  if (::ppoll(events.data(), events.size(), &timeout, nullptr) <= 0) return 0;
  return events[1].revents != 0 ? POLLNVAL : events[0].revents;
}

Grab V4l2Source::grab(std::chrono::nanoseconds timeout) {
  if (const std::optional<int> exposure_us = metering_.due()) {
    set_exposure(buffers_->device(), *exposure_us);
  }
  const std::int64_t deadline_ns = clock_.mono_ns() + timeout.count();
  Grab grab;
  do {
    const short told = wait(deadline_ns - clock_.mono_ns());
    if (told == POLLNVAL) {
      interrupted_.take();
      grab.kind = Grab::Kind::interrupted;
    } else if (told != 0) {
      drain(grab);
      if (grab.kind == Grab::Kind::timeout && (told & (POLLERR | POLLHUP)) != 0) {
        grab.lose(trouble_of(name_, "reports an error"));
      }
    }
  } while (grab.kind == Grab::Kind::timeout && clock_.mono_ns() < deadline_ns);
  return grab;
}

// Fetches all that the driver has filled: the newest good frame wins, the others go back at once.
void V4l2Source::drain(Grab& grab) {
  v4l2_buffer buffer;
  std::array<v4l2_plane, VIDEO_MAX_PLANES> planes{};
  int error = 0;
  while ((error = buffers_->dequeue(buffer, planes)) == 0) {
    if ((buffer.flags & V4L2_BUF_FLAG_ERROR) != 0) {
      refuse(buffer, DropCause::damaged, "the driver marked a frame as faulty", grab);
    } else if (const std::optional<ImageView> image = buffers_->view(buffer)) {
      take(buffer, *image, grab);
    } else {
      refuse(buffer, DropCause::too_short, "a frame was shorter than its format", grab);
    }
  }
  if (error == EAGAIN) return;
  grab.lose(trouble_of(name_, error == ENODEV ? kNotThere : "failed: " + error_text(error)));
}

void V4l2Source::take(const v4l2_buffer& buffer, const ImageView& image, Grab& grab) {
  const V4l2Stamp read = read_stamp(buffer, clock_.mono_ns(), clock_.utc_us() * 1000);
  grab.take(Frame(image, read.stamp, sequence_.extend(buffer.sequence), buffers_,
                  static_cast<int>(buffer.index)),
            read.corrected);
}

void V4l2Source::refuse(const v4l2_buffer& buffer, DropCause cause, std::string reason,
                        Grab& grab) {
  sequence_.extend(buffer.sequence);
  grab.refuse(cause, std::move(reason));
  buffers_->give_back(static_cast<int>(buffer.index));
}

}  // namespace

std::unique_ptr<FrameSource> make_v4l2_source(std::string device, CameraSettings settings,
                                              const Clock& clock) {
  return std::make_unique<V4l2Source>(std::move(device), settings, clock);
}

}  // namespace bole
