#include "capture/camera_report.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <sstream>

#include "base/errors.h"
#include "capture/frame_source.h"
#include "capture/libcamera/libcamera.h"
#include "capture/v4l2/list.h"

namespace bole {
namespace {

using Json = nlohmann::ordered_json;

Json number(std::optional<double> value) { return value ? Json(*value) : Json(nullptr); }

Json json_of(const CameraInfo& camera) {
  Json modes = Json::array();
  for (const CameraMode& mode : camera.modes) {
    modes.push_back({{"format", mode.format},
                     {"readable_as", mode.pixels ? Json(name(*mode.pixels)) : Json(nullptr)},
                     {"width", mode.size.width},
                     {"height", mode.size.height},
                     {"rates_hz", mode.rates_hz}});
  }
  Json controls = Json::array();
  for (const CameraControl& control : camera.controls) {
    controls.push_back({{"name", control.name},
                        {"min", number(control.min)},
                        {"max", number(control.max)},
                        {"default", number(control.fallback)},
                        {"value", number(control.value)}});
  }
  return {{"source", camera.source},           {"model", camera.model}, {"driver", camera.driver},
          {"other_names", camera.other_names}, {"modes", modes},        {"controls", controls}};
}

std::string shown(std::optional<double> value) {
  if (!value) return "?";
  std::ostringstream text;
  text << *value;
  return text.str();
}

}  // namespace

std::vector<CameraInfo> list_cameras(std::vector<std::string>& trouble) {
  std::vector<CameraInfo> cameras = list_v4l2_cameras();
  try {
    std::vector<CameraInfo> more = libcamera_plugin().list();
    std::ranges::move(more, std::back_inserter(cameras));
  } catch (const ConfigError& error) {
    trouble.emplace_back(error.what());
  } catch (const CaptureError& error) {
    trouble.emplace_back(error.what());
  }
  return cameras;
}

std::string text_report(const std::vector<CameraInfo>& cameras) {
  std::ostringstream text;
  if (cameras.empty()) text << "no camera is there\n";
  for (const CameraInfo& camera : cameras) {
    text << camera.source << "\n  " << camera.model << " (" << camera.driver << ")\n";
    for (const std::string& name : camera.other_names) text << "  also " << name << "\n";
    for (const CameraMode& mode : camera.modes) {
      text << "  " << mode.format << " " << mode.size.width << " x " << mode.size.height;
      for (std::size_t i = 0; i < mode.rates_hz.size(); ++i) {
        text << (i == 0 ? " at " : ", ") << mode.rates_hz[i];
      }
      text << (mode.rates_hz.empty() ? "" : " Hz") << (mode.pixels ? "" : " (cannot be read)")
           << "\n";
    }
    for (const CameraControl& control : camera.controls) {
      text << "  " << control.name << " = " << shown(control.value) << " (" << shown(control.min)
           << " to " << shown(control.max) << ", default " << shown(control.fallback) << ")\n";
    }
  }
  return text.str();
}

std::string json_report(const std::vector<CameraInfo>& cameras) {
  Json all = Json::array();
  for (const CameraInfo& camera : cameras) all.push_back(json_of(camera));
  // Names come from devices and may hold any byte.
  return all.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace bole
