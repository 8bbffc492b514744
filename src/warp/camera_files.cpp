#include "warp/camera_files.h"

#include "base/checksum.h"
#include "base/errors.h"
#include "base/files.h"
#include "geometry/ocam.h"
#include "geometry/pinhole.h"
#include "warp/mask.h"

namespace bole {
namespace {

constexpr std::size_t kLargestText = 1u << 20;

PinholeModel pinhole_of(const CameraConfig& config, const std::string& calibration_text,
                        const std::string& calibration_file) {
  return config.calibration.empty() ? pinhole_from_field_of_view(config.horizontal_fov, config.size)
                                    : parse_pinhole(calibration_text, calibration_file);
}

std::unique_ptr<const CameraModel> model_of(CameraConfig& config,
                                            const std::string& calibration_text,
                                            const std::string& calibration_file) {
  if (config.model == CameraConfig::Model::ocam) {
    return std::make_unique<OcamModel>(parse_ocam(calibration_text, calibration_file));
  }
  auto model =
      std::make_unique<PinholeModel>(pinhole_of(config, calibration_text, calibration_file));
  if (config.horizon_row) {
    const Pixel horizon{*config.horizon_row, model->parameters().centre_column};
    config.mount.pitch = pitch_of_forward_camera(model->ray_from_pixel(horizon), config.mount.roll);
  }
  return model;
}

// Lengths are part of it, so that no byte can move from one file to the next unseen.
std::uint32_t digest_of(const Camera& camera) {
  std::uint32_t crc = 0;
  const auto add = [&crc](const auto& bytes) {
    const std::uint64_t length = bytes.size();
    crc = crc32(std::as_bytes(std::span(&length, 1)), crc);
    crc = crc32(std::as_bytes(std::span(bytes)), crc);
  };
  add(camera.config_text);
  add(camera.calibration_text);
  add(camera.mask);
  return crc;
}

}  // namespace

Camera load_camera(const std::filesystem::path& camera_toml) {
  const std::filesystem::path folder = camera_toml.parent_path();
  Camera camera;
  camera.file = camera_toml;
  camera.config_text = read_text_file(camera_toml, kLargestText);
  camera.config = parse_camera_config(camera.config_text, camera_toml);
  const std::filesystem::path calibration = folder / camera.config.calibration;
  if (!camera.config.calibration.empty()) {
    camera.calibration_text = read_text_file(calibration, kLargestText);
  }
  camera.model = model_of(camera.config, camera.calibration_text, calibration);
  remount(camera, camera.config.mount);
  if (!camera.config.mask.empty()) {
    camera.mask = read_mask(folder / camera.config.mask, camera.model->image_size());
  }
  camera.digest = digest_of(camera);
  return camera;
}

void remount(Camera& camera, const Mount& mount) {
  camera.config.mount = mount;
  camera.robot_from_camera = camera.config.model == CameraConfig::Model::ocam
                                 ? robot_from_omni_camera(mount)
                                 : robot_from_forward_camera(mount);
}

}  // namespace bole
