#pragma once

#include <libcamera/camera_manager.h>

#include <memory>

namespace bole {

/// libcamera's one manager of a process, running for as long as somebody holds it. Throws
/// CaptureError when it does not start.
std::shared_ptr<libcamera::CameraManager> camera_manager();

}  // namespace bole
