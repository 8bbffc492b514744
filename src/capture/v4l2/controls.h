#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capture/camera_settings.h"
#include "capture/exposure.h"
#include "capture/v4l2/device.h"

namespace bole {

/// Sets exposure, gain, white balance and power-line frequency as far as they are asked for.
/// Returns a line for each that the camera refused or changed: "gain = 300: the camera takes 255
/// for 300". Throws CaptureError when it does not answer.
std::vector<std::string> apply_controls(const V4l2Device& device, const CameraSettings& settings);

/// Sets an exposure time, one of the camera's exposure_range(). False when it refuses.
bool set_exposure(const V4l2Device& device, int exposure_us);

/// The exposure times that the camera can; nullopt when it does not say. Throws CaptureError when
/// it does not answer.
std::optional<ExposureRange> exposure_range(const V4l2Device& device);

}  // namespace bole
