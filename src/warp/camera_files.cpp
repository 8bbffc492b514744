#include "warp/camera_files.h"

#include "base/checksum.h"
#include "base/errors.h"
#include "base/files.h"
#include "geometry/fisheye.h"
#include "geometry/ocam.h"
#include "geometry/omnidir.h"
#include "geometry/pinhole.h"
#include "warp/mask.h"

namespace bole {
namespace {

constexpr std::size_t kLargestText = 1u << 20;

std::unique_ptr<const CameraModel> model_of(const Camera& camera, const std::string& file) {
  const CameraConfig& config = camera.config;
  const std::string& text = camera.calibration_text;
  switch (config.model) {
    case CameraConfig::Model::ocam:
      return std::make_unique<OcamModel>(parse_ocam(text, file));
    case CameraConfig::Model::fisheye:
      return std::make_unique<FisheyeModel>(parse_fisheye(text, file, config.size));
    case CameraConfig::Model::omnidir:
      return std::make_unique<OmnidirModel>(parse_omnidir(text, file, config.size));
    case CameraConfig::Model::pinhole:
      break;
  }
  return std::make_unique<PinholeModel>(
      config.calibration.empty() ? pinhole_from_field_of_view(config.horizontal_fov, config.size)
                                 : parse_pinhole(text, file, config.size));
}

double pitch_of_horizon(const Camera& camera, double row) {
  const auto& pinhole = dynamic_cast<const PinholeModel&>(*camera.model);
  const Vec3 ray = pinhole.ray_from_pixel({row, pinhole.parameters().matrix.centre_column});
  if (!is_ray(ray)) {
    throw ConfigError(camera.file, "mount.horizon_row",
                      "lies where the calibration knows of no ray", "give pitch_deg instead");
  }
  return pitch_of_forward_camera(ray, camera.config.mount.roll);
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

std::filesystem::path mask_file(const Camera& camera) {
  if (camera.config.mask.empty()) return {};
  return camera.file.parent_path() / camera.config.mask;
}

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
  camera.model = model_of(camera, calibration);
  if (camera.config.horizon_row) {
    camera.config.mount.pitch = pitch_of_horizon(camera, *camera.config.horizon_row);
  }
  remount(camera, camera.config.mount);
  const std::filesystem::path mask = mask_file(camera);
  if (!mask.empty()) camera.mask = read_mask(mask, camera.model->image_size());
  camera.digest = digest_of(camera);
  return camera;
}

void remount(Camera& camera, const Mount& mount) {
  camera.config.mount = mount;
  switch (camera.config.model) {
    case CameraConfig::Model::ocam:
      camera.robot_from_camera = robot_from_omni_camera(mount);
      break;
    case CameraConfig::Model::fisheye:
    case CameraConfig::Model::omnidir:
      camera.robot_from_camera = robot_from_omni_opencv_camera(mount);
      break;
    case CameraConfig::Model::pinhole:
      camera.robot_from_camera = robot_from_forward_camera(mount);
      break;
  }
}

}  // namespace bole
