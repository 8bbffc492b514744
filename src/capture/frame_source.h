#pragma once

#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>

#include "capture/frame.h"

namespace bole {

/// Why a source could not be opened. Trying again later is sensible: the camera may come.
class CaptureError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What came of waiting for a frame.
struct Grab {
  enum class Kind {
    frame,      ///< `frame` holds the newest one
    timeout,    ///< nothing came in time
    bad_frame,  ///< one came and could not be used; `reason` says why
    lost,       ///< the camera is gone; close() and open() again
    end,        ///< a replay is over
    interrupted,
  };
  Kind kind = Kind::timeout;
  Frame frame;
  int superseded = 0;  ///< older frames given back unused in favour of this one
  std::string reason;
};

/// A camera, or files in place of one. One thread uses it; interrupt() may come from any.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// Finds the camera by its stable name and starts it. Throws CaptureError; the source is then
  /// closed, and open() may be tried again.
  virtual void open() = 0;
  /// Waits at most `timeout` for the newest frame. Only between open() and close().
  virtual Grab grab(std::chrono::nanoseconds timeout) = 0;
  /// Stops the camera. Frames still held elsewhere stay valid until they are dropped.
  virtual void close() noexcept = 0;
  /// Makes a grab() that waits, or the next one, return `interrupted`.
  virtual void interrupt() noexcept = 0;
  /// One line for logs and the status: device, format, size, rate as negotiated.
  virtual std::string description() const = 0;
};

}  // namespace bole
