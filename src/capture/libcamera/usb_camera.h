#pragma once

#include <string>

#include "base/files.h"

namespace bole {

/// Whether `id`, libcamera's name of a camera, is that of a USB camera that the kernel does not
/// have.
bool usb_camera_is_missing(const std::string& id);

/// Tells at once that a USB camera was pulled out. libcamera hears of it from udev, on a busy
/// machine seconds later; the kernel wakes whoever has the camera's node open.
class UnplugWatch {
 public:
  /// `id`: libcamera's name of the camera. One that is not on USB is not watched.
  explicit UnplugWatch(const std::string& id);

  /// To be polled for POLLPRI; -1 when nothing is watched, which poll() passes over.
  int fd() const { return node_.get(); }
  bool unplugged() const noexcept;

 private:
  UniqueFd node_;
};

}  // namespace bole
