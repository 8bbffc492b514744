#pragma once

#include <string>

#include "geometry/camera_config.h"

namespace bole {

/// The keys of [mount] that say how this camera is tilted, for sentences: "centre, roll_deg and
/// pitch_deg".
std::string tilt_keys(const CameraConfig& config);

}  // namespace bole
