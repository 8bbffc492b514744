#pragma once

#include <filesystem>
#include <string>

#include "service/daemon_config.h"

namespace bole {

/// What grab_frame() wrote.
struct GrabbedFrame {
  std::string description;  ///< of the camera, as negotiated
  std::filesystem::path file;
};

/// Takes one frame from config.source and writes it as it came, tightly packed, to `base` and the
/// name of its format (".yuyv"; ".jpg" of MJPEG), which replay reads again; a folder gets "frame".
/// The first few frames are let pass, so that the camera's exposure settles. Throws CaptureError
/// when no frame comes within ten seconds, ConfigError as the daemon does.
GrabbedFrame grab_frame(const DaemonConfig& config, const std::filesystem::path& base);

}  // namespace bole
