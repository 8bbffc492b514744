#pragma once

#include <linux/videodev2.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/files.h"

namespace bole {

/// An open Video4Linux device node.
class V4l2Device {
 public:
  V4l2Device() = default;
  /// Opens it for non-blocking use; each ask() calls `before_asking`. Throws CaptureError with the
  /// reason.
  explicit V4l2Device(const std::filesystem::path& path, std::function<void()> before_asking = {});

  /// One ioctl, repeated when a signal interrupts it. 0, or errno.
  int call(unsigned long request, void* argument) const noexcept;
  /// call() while the camera is being opened. Throws CaptureError when it does not answer, since
  /// that takes the kernel seconds to find out and would be the same for the next question; and
  /// what `before_asking` throws.
  int ask(unsigned long request, void* argument) const;
  int fd() const { return fd_.get(); }
  void close() { fd_.reset(); }

  /// What it says of itself. Throws CaptureError when it is no V4L2 device.
  v4l2_capability capability() const;
  /// V4L2_BUF_TYPE_VIDEO_CAPTURE or, where it offers that only, its multi-planar sibling. Throws
  /// CaptureError when it gives no streams of frames.
  v4l2_buf_type capture_type() const;

 private:
  UniqueFd fd_;
  std::function<void()> before_asking_;
};

/// The node of the camera called `name`, resolved anew at each call: a path (best one below
/// /dev/v4l/by-id or /dev/v4l/by-path, which stays the same over replugs), a name in one of these
/// folders, or the serial number of a USB camera. Throws CaptureError when it is not there.
std::filesystem::path find_v4l2_device(const std::string& name);

/// All video nodes of the system, in the order of their numbers.
std::vector<std::filesystem::path> v4l2_nodes();

/// The USB serial number of the camera behind `node` (/dev/videoN); empty when it has none.
std::string usb_serial(const std::filesystem::path& node);

/// The links below /dev/v4l that lead to `node`, by-id first.
std::vector<std::filesystem::path> stable_names(const std::filesystem::path& node);

}  // namespace bole
