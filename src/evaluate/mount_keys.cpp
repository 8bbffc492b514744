#include "evaluate/mount_keys.h"

namespace bole {

std::string tilt_keys(const CameraConfig& config) {
  if (looks_all_round(config.model)) return "centre, roll_deg and pitch_deg";
  return config.horizon_row ? "horizon_row and roll_deg" : "pitch_deg and roll_deg";
}

}  // namespace bole
