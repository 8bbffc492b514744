#pragma once

#include <libcamera/camera.h>
#include <libcamera/controls.h>

#include <optional>
#include <string>
#include <vector>

#include "capture/camera_info.h"
#include "capture/camera_settings.h"
#include "capture/exposure.h"

namespace bole {

/// The one place that knows how libcamera's versions differ: what its controls are called and mean.
/// Tried from 0.0.3 (Debian 12) on.

/// The settings as controls to start the camera with. What the camera has no control for is named
/// in `refused`, a line each.
libcamera::ControlList make_controls(const libcamera::Camera& camera,
                                     const CameraSettings& settings,
                                     std::vector<std::string>& refused);

/// The exposure times that the camera can; nullopt when it takes none from us.
std::optional<ExposureRange> exposure_range(const libcamera::Camera& camera);
void set_exposure(libcamera::ControlList& controls, int exposure_us);

/// The camera's controls that have a number for a value.
std::vector<CameraControl> list_controls(const libcamera::Camera& camera);

/// "libcamera 0.0.3": what this was compiled against.
std::string libcamera_version();

}  // namespace bole
