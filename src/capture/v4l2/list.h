#pragma once

#include <vector>

#include "capture/camera_info.h"

namespace bole {

/// The Video4Linux cameras that are there and may be opened, in the order of their nodes.
std::vector<CameraInfo> list_v4l2_cameras();

}  // namespace bole
