#include "bench/bench_scene.h"

#include <turbojpeg.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

#include "geometry/angles.h"
#include "geometry/ground.h"
#include "geometry/ocam.h"

namespace bole::bench {
namespace {

OcamModel scaled(const OcamModel& model, ImageSize size) {
  OcamModel::Parameters p = model.parameters();
  const double scale = size.width / static_cast<double>(p.size.width);
  for (std::size_t k = 0; k < p.direct.size(); ++k) {
    p.direct[k] *= std::pow(scale, 1.0 - static_cast<double>(k));
  }
  for (double& coefficient : p.inverse) coefficient *= scale;
  p.centre_row = (p.centre_row + 0.5) * scale - 0.5;
  p.centre_column = (p.centre_column + 0.5) * scale - 0.5;
  p.size = size;
  return OcamModel(std::move(p));
}

Camera scaled_example(ImageSize size) {
  Camera camera = load_camera(BOLE_SOURCE_DIR "/calib/example/camera.toml");
  const ImageSize from = camera.model->image_size();
  std::vector<std::uint8_t> mask;
  for (int row = 0; row < size.height; ++row) {
    for (int column = 0; column < size.width; ++column) {
      mask.push_back(camera.mask[static_cast<std::size_t>(
          row * from.height / size.height * from.width + column * from.width / size.width)]);
    }
  }
  camera.mask = std::move(mask);
  camera.model =
      std::make_unique<OcamModel>(scaled(dynamic_cast<const OcamModel&>(*camera.model), size));
  return camera;
}

std::uint32_t scramble(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352dU;
  x = (x ^ (x >> 15)) * 0x846ca68bU;
  return x ^ (x >> 16);
}

int noise(int a, int b) {  // 0 .. 31
  return static_cast<int>(scramble(static_cast<std::uint32_t>(a * 65537 + b)) & 31);
}

// Trunks stand at even bearings, from 1.5 to 8 m away, most of them dark; sky above, ground below.
int grey_level(double bearing, double tangent, double height) {
  constexpr int kTrunks = 24;
  constexpr double kSpacing = 2 * kPi / kTrunks;
  const int trunk = static_cast<int>((bearing + kPi) / kSpacing) % kTrunks;
  const double range = 1.5 + (trunk * 7 % kTrunks) * 0.28;
  const double width = angular_width(0.25 + (trunk % 5) * 0.12, range);
  const double across = std::abs(bearing + kPi - (trunk + 0.5) * kSpacing);
  const int texture = noise(static_cast<int>(bearing * 200), static_cast<int>(tangent * 60));
  if (across < width / 2 && tangent > ground_tangent(range, height)) {
    return (trunk % 6 == 0 ? 170 : 40) + texture;
  }
  return (tangent > 0 ? 120 + 2 * texture : 95 + texture);
}

std::vector<std::byte> paint(const Camera& camera) {
  const ImageSize size = camera.model->image_size();
  std::vector<std::byte> green;
  for (int row = 0; row < size.height; ++row) {
    for (int column = 0; column < size.width; ++column) {
      const Vec3 ray =
          camera.robot_from_camera * camera.model->ray_from_pixel({double(row), double(column)});
      const double tangent = std::clamp(ray.z / std::hypot(ray.x, ray.y), -10.0, 10.0);
      const int level = grey_level(std::atan2(ray.y, ray.x), tangent, camera.config.mount.height);
      green.push_back(std::byte(std::clamp(level + noise(row, column) / 4 - 4, 0, 255)));
    }
  }
  return green;
}

std::vector<std::byte> jpeg(const std::vector<std::byte>& rgb, ImageSize size) {
  const std::unique_ptr<void, int (*)(void*)> handle(tjInitCompress(), tjDestroy);
  unsigned char* bytes = nullptr;
  unsigned long length = 0;
  const int status =
      tjCompress2(handle.get(), reinterpret_cast<const unsigned char*>(rgb.data()), size.width, 0,
                  size.height, TJPF_RGB, &bytes, &length, TJSAMP_422, 90, 0);
  const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owner(bytes, tjFree);
  if (status != 0) throw std::runtime_error(tjGetErrorStr2(handle.get()));
  const auto* const first = reinterpret_cast<const std::byte*>(bytes);
  return {first, first + length};
}

}  // namespace

Scene make_scene(ImageSize size, const std::function<void(CameraConfig&)>& change) {
  Camera camera = scaled_example(size);
  if (change) change(camera.config);
  WarpTable table = build_warp_table(camera);
  std::vector<std::byte> green = paint(camera);
  return {std::move(camera), std::move(table), std::move(green)};
}

std::vector<std::byte> Scene::frame(PixelFormat format) const {
  const ImageSize size = table.image_size();
  std::vector<std::byte> bytes;
  switch (format) {
    case PixelFormat::yuyv:
      for (const std::byte value : green) bytes.insert(bytes.end(), {value, std::byte{128}});
      return bytes;
    case PixelFormat::uyvy:
      for (const std::byte value : green) bytes.insert(bytes.end(), {std::byte{128}, value});
      return bytes;
    case PixelFormat::rgb24:
    case PixelFormat::bgr24:
      for (const std::byte value : green) bytes.insert(bytes.end(), 3, value);
      return bytes;
    case PixelFormat::mjpeg:
      return jpeg(frame(PixelFormat::rgb24), size);
    default:
      bytes = green;
      bytes.resize(packed_frame_bytes(format, size), std::byte{128});
      return bytes;
  }
}

const Scene& scene(ImageSize size) {
  static std::map<int, Scene> scenes;
  const auto found = scenes.find(size.width);
  return found != scenes.end() ? found->second
                               : scenes.emplace(size.width, make_scene(size)).first->second;
}

std::string name_of(const std::string& subject, ImageSize size) {
  return subject + "/" + std::to_string(size.width) + "x" + std::to_string(size.height);
}

}  // namespace bole::bench
