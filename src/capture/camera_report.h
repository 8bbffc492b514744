#pragma once

#include <string>
#include <vector>

#include "capture/camera_info.h"

namespace bole {

/// All cameras that are there, by every driver; `trouble` gets a line for a driver that cannot say.
std::vector<CameraInfo> list_cameras(std::vector<std::string>& trouble);

/// The cameras for a person: names, formats with sizes and rates, controls.
std::string text_report(const std::vector<CameraInfo>& cameras);

/// The same for a program: one line, a JSON array of objects. A mode has `format`, `readable_as`
/// (null: it cannot be read), `width`, `height`, `rates_hz`; a control `name` and the numbers
/// `min`, `max`, `default`, `value`, each null where the driver does not say.
std::string json_report(const std::vector<CameraInfo>& cameras);

}  // namespace bole
