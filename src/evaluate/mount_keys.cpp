#include "evaluate/mount_keys.h"

namespace bole {

bool sees_all_round(const CameraConfig& config) {
  return config.model != CameraConfig::Model::pinhole;
}

std::string tilt_keys(const CameraConfig& config) {
  if (sees_all_round(config)) return "centre, roll_deg and pitch_deg";
  return config.horizon_row ? "horizon_row and roll_deg" : "pitch_deg and roll_deg";
}

}  // namespace bole
