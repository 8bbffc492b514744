#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/clock.h"
#include "capture/camera_info.h"
#include "capture/camera_settings.h"
#include "capture/frame_source.h"

namespace bole {

/// What the plug-in bole_libcamera.so offers: libcamera's ABI changes with every release, so that
/// the programs do not link it.
class LibcameraPlugin {
 public:
  virtual ~LibcameraPlugin() = default;
  virtual std::unique_ptr<FrameSource> make_source(std::string id, const CameraSettings& settings,
                                                   const Clock& clock) const = 0;
  virtual std::vector<CameraInfo> list() const = 0;
};

/// The plug-in. Throws ConfigError when it is not installed or cannot be loaded.
const LibcameraPlugin& libcamera_plugin();

/// The camera that libcamera calls `id`. It is looked for at each open(); whoever comes late gets
/// the newest frame. `clock` must outlive the source. Throws ConfigError like libcamera_plugin().
std::unique_ptr<FrameSource> make_libcamera_source(std::string id, const CameraSettings& settings,
                                                   const Clock& clock);

}  // namespace bole
