#pragma once

#include <chrono>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/wakeup.h"
#include "capture/drops.h"
#include "capture/frame.h"

namespace bole {

/// Why a camera could not be opened. Trying again later is sensible: it may come, or come right.
class CaptureError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Why there is no camera, in the same words whether it was lost or not found: one outage is told
/// once. The camera's name comes last, in brackets, since a status has room for 80 bytes.
inline const std::string kNotThere = "is not there";
inline const std::string kPlugItIn = "; plug it in, or choose from bolectl cameras";
inline std::string in_brackets(const std::string& name) { return " (" + name + ")"; }
/// What went wrong with the camera `name`, and after all else, for logs, what mends its absence.
inline std::string trouble_of(const std::string& name, const std::string& reason) {
  return reason + in_brackets(name) + (reason == kNotThere ? kPlugItIn : "");
}

/// What came of waiting for a frame.
struct Grab {
  enum class Kind {
    frame,        ///< `frame` holds the newest one
    timeout,      ///< none came in time
    bad_frame,    ///< only such came as cannot be used
    lost,         ///< the camera is gone; close() and open() again
    end,          ///< a replay is over
    interrupted,  ///< by interrupt()
  };
  Kind kind = Kind::timeout;
  Frame frame;
  DropCounts drops;          ///< frames that came before this one and were not used
  int stamps_corrected = 0;  ///< stamps that lay in the future and were set to now
  std::string reason;        ///< of the last bad frame, or of the loss; else empty

  /// A good frame has come: the newest wins, the one before goes back.
  void take(Frame newest, bool stamp_corrected);
  /// One has come that cannot be used.
  void refuse(DropCause cause, std::string why);
  /// The camera is gone, and what else was fetched of it is of no interest.
  void lose(std::string why);
};

/// A camera, or files in place of one. One thread uses it; interrupt() may come from any.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// Finds the camera by its stable name and starts it. Throws CaptureError; the source is then
  /// closed, and open() may be tried again. A camera is told many things one after the other and
  /// may take seconds over each: see on_step(); interrupt() ends it between two.
  virtual void open() = 0;
  /// Waits at most `timeout` for the newest frame. Only between open() and close().
  virtual Grab grab(std::chrono::nanoseconds timeout) = 0;
  /// Stops the camera. Frames still held elsewhere stay valid until they are dropped.
  virtual void close() noexcept = 0;
  /// Makes a grab() that waits, or the next one, return `interrupted`, and an open() throw.
  virtual void interrupt() noexcept = 0;
  /// Time from a frame to the next as negotiated; 0 while it is not known.
  virtual std::chrono::nanoseconds frame_period() const = 0;
  /// One line for logs and the status, which may cut its end: format, size, rate as negotiated,
  /// then the device.
  virtual std::string description() const = 0;
  /// What was asked for at the last open() and the camera would not do, a line each.
  virtual std::vector<std::string> refused() const { return {}; }
  /// Tells how bright the panorama of a recent frame is: the mean of its seen pixels, 0 to 255. A
  /// camera whose exposure we meter acts on it. From any thread.
  virtual void metered(double /*mean*/) noexcept {}

  /// `on_step` is called by each open(), in its thread, before each thing that the camera is told.
  void on_step(std::function<void()> on_step) { on_step_ = std::move(on_step); }

 protected:
  /// To be called by open() at each step: tells of it. Throws CaptureError once `interrupted`.
  void step(const Wakeup& interrupted) const {
    if (interrupted.wait(0)) throw CaptureError("is not opened: interrupted");
    if (on_step_) on_step_();
  }

 private:
  std::function<void()> on_step_;
};

}  // namespace bole
