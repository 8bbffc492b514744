#pragma once

#include <memory>
#include <string>

#include "base/clock.h"
#include "capture/camera_settings.h"
#include "capture/frame_source.h"

namespace bole {

/// A Video4Linux camera by its stable name (see find_v4l2_device), looked up anew at each open(),
/// since a camera that comes back may have another node. Streams through mapped buffers of the
/// driver; whoever comes late gets the newest frame. `clock` must outlive the source.
std::unique_ptr<FrameSource> make_v4l2_source(std::string device, CameraSettings settings,
                                              const Clock& clock);

}  // namespace bole
