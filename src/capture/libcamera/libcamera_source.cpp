// The plug-in bole_libcamera.so: libcamera's cameras behind FrameSource.
#include <libcamera/camera.h>
#include <libcamera/property_ids.h>
#include <poll.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/errors.h"
#include "capture/libcamera/formats.h"
#include "capture/libcamera/libcamera.h"
#include "capture/libcamera/manager.h"
#include "capture/libcamera/session.h"
#include "capture/libcamera/settings.h"
#include "capture/libcamera/usb_camera.h"
#include "capture/plugin.h"
#include "capture/sequence_count.h"

namespace bole {
namespace {

constexpr std::chrono::seconds kLibcameraPatience{5};

libcamera::Size theirs(ImageSize size) {
  return {static_cast<unsigned>(size.width), static_cast<unsigned>(size.height)};
}

// The camera, ours alone until it is released.
class Acquired {
 public:
  explicit Acquired(std::shared_ptr<libcamera::Camera> camera) : camera_(std::move(camera)) {
    const int error = camera_->acquire();
    if (error == -EBUSY) throw CaptureError("is in use by another program");
    if (error != 0) throw CaptureError("cannot be had: " + error_text(-error));
  }
  Acquired(const Acquired&) = delete;
  Acquired& operator=(const Acquired&) = delete;
  ~Acquired() {
    if (camera_) camera_->release();
  }
  libcamera::Camera& operator*() const { return *camera_; }
  // Whoever takes it over releases it.
  std::shared_ptr<libcamera::Camera> take() { return std::move(camera_); }

 private:
  std::shared_ptr<libcamera::Camera> camera_;
};

struct Agreed {
  std::unique_ptr<libcamera::CameraConfiguration> configuration;
  BufferLayout layout;
};

// Configures the camera for the first of our formats that it gives in the wanted size.
Agreed configure(libcamera::Camera& camera, const CameraSettings& settings) {
  Agreed agreed;
  agreed.configuration = camera.generateConfiguration({libcamera::StreamRole::VideoRecording});
  if (!agreed.configuration || agreed.configuration->empty()) {
    throw CaptureError("gives no stream of video frames");
  }
  libcamera::StreamConfiguration& stream = agreed.configuration->at(0);
  for (const LibcameraFormat& format : kLibcameraFormats) {
    if (settings.format && format.ours != *settings.format) continue;
    stream.pixelFormat = format.theirs;
    stream.size = theirs(settings.size);
    stream.bufferCount = static_cast<unsigned>(settings.buffers);
    if (agreed.configuration->validate() == libcamera::CameraConfiguration::Invalid ||
        stream.pixelFormat != format.theirs || stream.size != theirs(settings.size)) {
      continue;
    }
    if (const int error = camera.configure(agreed.configuration.get()); error != 0) {
      throw CaptureError("takes no configuration: " + error_text(-error));
    }
    const auto stride = static_cast<int>(stream.stride);
    agreed.layout.pixels = format.ours;
    agreed.layout.size = settings.size;
    agreed.layout.memory_planes = format.ours == PixelFormat::nv12 ? 2 : 1;
    agreed.layout.strides.fill(
        std::max(stride, packed_row_bytes(format.ours, settings.size.width)));
    return agreed;
  }
  throw CaptureError(
      "offers " + stream.toString() + ", the calibration is for " + shown(settings.size) +
      (settings.format ? ", source.format is " + std::string(name(*settings.format)) : ""));
}

class LibcameraSource final : public FrameSource {
 public:
  LibcameraSource(std::string id, const CameraSettings& settings, const Clock& clock)
      : id_(std::move(id)), settings_(settings), clock_(clock) {}
  LibcameraSource(const LibcameraSource&) = delete;
  LibcameraSource& operator=(const LibcameraSource&) = delete;
  ~LibcameraSource() override {
    close();
    if (unplugged_) unplugged_->await_libcamera(kLibcameraPatience);
  }

  void open() override {
    try {
      forget_unplugged();
      start();
    } catch (const CaptureError& error) {
      if (!unplugged_) manager_.reset();
      throw CaptureError(trouble_of(id_, error.what()));
    }
  }
  Grab grab(std::chrono::nanoseconds timeout) override;
  void close() noexcept override {
    if (session_ && session_->libcamera_lags()) {
      unplugged_ = session_;
    } else if (session_) {
      session_->stop();
      manager_.reset();
    }
    session_.reset();
    metering_.stop();
  }
  void interrupt() noexcept override { interrupted_.raise(); }
  std::chrono::nanoseconds frame_period() const override { return period_; }
  std::string description() const override { return description_; }
  std::vector<std::string> refused() const override { return refused_; }
  void metered(double mean) noexcept override { metering_.tell(mean); }

 private:
  void forget_unplugged();
  void start();
  void expose();
  void wait(std::int64_t timeout_ns) const;
  void drain(Grab& grab);
  void take(const LibcameraSession::Completed& completed, const ImageView& image, Grab& grab);
  void refuse(const LibcameraSession::Completed& completed, DropCause cause, std::string reason,
              Grab& grab);

  const std::string id_;
  const CameraSettings settings_;
  const Clock& clock_;
  Wakeup interrupted_;
  // Only while the camera is open: libcamera 0.0.3 crashes when it sees a device's number come
  // back.
  std::shared_ptr<libcamera::CameraManager> manager_;
  std::shared_ptr<LibcameraSession> session_;
  std::shared_ptr<LibcameraSession> unplugged_;  // closed, but libcamera does not know yet
  SequenceCount sequence_;
  Metering metering_;
  bool metering_held_ = false;  // below the frame period
  std::chrono::nanoseconds period_{0};
  std::int64_t first_stamp_ns_ = 0;
  std::int64_t first_sequence_ = 0;
  std::int64_t last_stamp_ns_ = 0;
  std::int64_t last_sequence_ = 0;
  std::string description_;
  std::vector<std::string> refused_;
};

void LibcameraSource::forget_unplugged() {
  if (!unplugged_) return;
  if (unplugged_->libcamera_lags()) throw CaptureError(kNotThere);
  unplugged_->stop();
  unplugged_.reset();
  manager_.reset();
}

void LibcameraSource::start() {
  if (usb_camera_is_missing(id_)) throw CaptureError(kNotThere);
  step(interrupted_);
  manager_ = camera_manager();
  auto camera = manager_->get(id_);
  if (!camera) throw CaptureError(kNotThere);
  step(interrupted_);
  Acquired acquired(std::move(camera));
  step(interrupted_);
  const Agreed agreed = configure(*acquired, settings_);
  refused_.clear();
  const libcamera::ControlList controls = make_controls(*acquired, settings_, refused_);
  std::string unmetered = metering_.start(settings_, exposure_range(*acquired));
  if (!unmetered.empty()) refused_.push_back(std::move(unmetered));
  metering_held_ = false;
  first_stamp_ns_ = 0;
  sequence_ = {};
  period_ = std::chrono::nanoseconds(0);
  last_stamp_ns_ = 0;
  const libcamera::StreamConfiguration& stream = agreed.configuration->at(0);
  step(interrupted_);
  session_ =
      std::make_shared<LibcameraSession>(acquired.take(), stream.stream(), agreed.layout, controls);
  description_ = stream.toString() + ", " + std::to_string(session_->count()) + " buffers, " + id_ +
                 in_brackets(libcamera_version());
}

// Sets the exposure that the last brightness told of calls for, once it is known how long a frame
// takes: libcamera does not say, and a longer exposure would make it longer.
void LibcameraSource::expose() {
  constexpr std::int64_t kFramesToKnow = 10;
  const std::int64_t frames = last_sequence_ - first_sequence_;
  if (first_stamp_ns_ == 0 || frames < kFramesToKnow) return;
  if (!metering_held_) {
    metering_.hold_below(std::chrono::nanoseconds((last_stamp_ns_ - first_stamp_ns_) / frames));
  }
  metering_held_ = true;
  if (const std::optional<int> exposure_us = metering_.due()) session_->expose(*exposure_us);
}

void LibcameraSource::wait(std::int64_t timeout_ns) const {
  constexpr std::int64_t kSecond = 1'000'000'000;
  timeout_ns = std::max<std::int64_t>(timeout_ns, 0);
  const timespec timeout{timeout_ns / kSecond, timeout_ns % kSecond};
  std::array<pollfd, 3> events{pollfd{session_->fd(), POLLIN, 0},
                               pollfd{session_->unplug_fd(), POLLPRI, 0},
                               pollfd{interrupted_.fd(), POLLIN, 0}};
  ::ppoll(events.data(), events.size(), &timeout, nullptr);
}

Grab LibcameraSource::grab(std::chrono::nanoseconds timeout) {
  expose();
  const std::int64_t deadline_ns = clock_.mono_ns() + timeout.count();
  Grab grab;
  do {
    wait(deadline_ns - clock_.mono_ns());
    if (interrupted_.take()) {
      grab.kind = Grab::Kind::interrupted;
    } else {
      drain(grab);
    }
  } while (grab.kind == Grab::Kind::timeout && clock_.mono_ns() < deadline_ns);
  return grab;
}

// Takes all that was completed: the newest good frame wins, the others go back at once.
void LibcameraSource::drain(Grab& grab) {
  std::array<LibcameraSession::Completed, LibcameraSession::kMaxBuffers> posted;
  const int count = session_->take(posted);
  for (const LibcameraSession::Completed& completed : std::span(posted).first(count)) {
    if (!completed.good) {
      refuse(completed, DropCause::damaged, "libcamera marked a frame as faulty", grab);
    } else if (const std::optional<ImageView> image = session_->view(completed)) {
      take(completed, *image, grab);
    } else {
      refuse(completed, DropCause::too_short, "a frame was shorter than its format", grab);
    }
  }
  if (session_->gone()) grab.lose(trouble_of(id_, kNotThere));
}

void LibcameraSource::take(const LibcameraSession::Completed& completed, const ImageView& image,
                           Grab& grab) {
  const std::int64_t now_ns = clock_.mono_ns();
  const bool corrected = completed.stamp_ns > now_ns || completed.stamp_ns == 0;
  const std::int64_t stamp_ns = corrected ? now_ns : completed.stamp_ns;
  const std::int64_t sequence = sequence_.extend(completed.sequence);
  if (last_stamp_ns_ > 0 && sequence > last_sequence_ && stamp_ns > last_stamp_ns_) {
    period_ = std::chrono::nanoseconds((stamp_ns - last_stamp_ns_) / (sequence - last_sequence_));
  }
  if (first_stamp_ns_ == 0) {
    first_stamp_ns_ = stamp_ns;
    first_sequence_ = sequence;
  }
  last_stamp_ns_ = stamp_ns;
  last_sequence_ = sequence;
  grab.take(Frame(image, {StampClock::monotonic, stamp_ns}, sequence, session_, completed.index),
            corrected);
}

void LibcameraSource::refuse(const LibcameraSession::Completed& completed, DropCause cause,
                             std::string reason, Grab& grab) {
  sequence_.extend(completed.sequence);
  grab.refuse(cause, std::move(reason));
  session_->give_back(completed.index);
}

CameraInfo describe(libcamera::Camera& camera) {
  CameraInfo info;
  info.source = "libcamera:" + camera.id();
  info.model = camera.properties().get(libcamera::properties::Model).value_or("");
  info.driver = libcamera_version();
  info.controls = list_controls(camera);
  const auto configuration = camera.generateConfiguration({libcamera::StreamRole::VideoRecording});
  if (!configuration || configuration->empty()) return info;
  const libcamera::StreamFormats& formats = configuration->at(0).formats();
  for (const libcamera::PixelFormat& format : formats.pixelformats()) {
    const auto* const known =
        std::ranges::find(kLibcameraFormats, format, &LibcameraFormat::theirs);
    for (const libcamera::Size& size : formats.sizes(format)) {
      CameraMode mode;
      mode.format = format.toString();
      if (known != kLibcameraFormats.end()) mode.pixels = known->ours;
      mode.size = {static_cast<int>(size.width), static_cast<int>(size.height)};
      info.modes.push_back(std::move(mode));
    }
  }
  return info;
}

class Plugin : public LibcameraPlugin {
 public:
  std::unique_ptr<FrameSource> make_source(std::string id, const CameraSettings& settings,
                                           const Clock& clock) const override {
    return std::make_unique<LibcameraSource>(std::move(id), settings, clock);
  }
  std::vector<CameraInfo> list() const override {
    std::vector<CameraInfo> cameras;
    const auto manager = camera_manager();
    for (const auto& camera : manager->cameras()) cameras.push_back(describe(*camera));
    return cameras;
  }
};

}  // namespace
}  // namespace bole

BOLE_PLUGIN;

extern "C" __attribute__((visibility("default"))) const bole::LibcameraPlugin& bole_libcamera() {
  static const bole::Plugin plugin;
  return plugin;
}
