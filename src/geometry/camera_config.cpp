#include "geometry/camera_config.h"

#include <algorithm>
#include <array>

#include "geometry/angles.h"

namespace bole {
namespace {

ImageSide side(TomlTable& table, std::string_view key, std::string_view fallback) {
  const std::string text =
      table.choice(key, fallback, {"image up", "image down", "image left", "image right"});
  if (text == "image up") return ImageSide::up;
  if (text == "image down") return ImageSide::down;
  return text == "image left" ? ImageSide::left : ImageSide::right;
}

bool along_rows(ImageSide side) { return side == ImageSide::up || side == ImageSide::down; }

struct NamedModel {
  std::string_view name;
  CameraConfig::Model model;
};
constexpr std::array<NamedModel, 4> kModels = {{{"ocam", CameraConfig::Model::ocam},
                                                {"fisheye", CameraConfig::Model::fisheye},
                                                {"omnidir", CameraConfig::Model::omnidir},
                                                {"pinhole", CameraConfig::Model::pinhole}}};

CameraConfig::Model model(TomlTable& table) {
  std::vector<std::string> names(kModels.size());
  std::ranges::transform(kModels, names.begin(), [](const auto& m) { return std::string(m.name); });
  return std::ranges::find(kModels, table.choice("model", kModels.front().name, names),
                           &NamedModel::name)
      ->model;
}

ImageSize size(TomlTable& table) {
  return {table.required_integer("width", {1, 20000}),
          table.required_integer("height", {1, 20000})};
}

void read_camera(TomlTable table, CameraConfig& config) {
  config.model = model(table);
  config.calibration = table.text("calibration", "");
  config.mask = table.text("mask", "");
  if (config.model == CameraConfig::Model::pinhole && config.calibration.empty()) {
    config.horizontal_fov = radians(table.required_number("horizontal_fov_deg", {1, 170}));
    config.size = size(table);
  } else if (config.calibration.empty()) {
    table.fail("calibration", "is missing",
               config.model == CameraConfig::Model::ocam ? "name OCamCalib's calib_results.txt"
                                                         : "name OpenCV's YAML");
  } else if (config.model != CameraConfig::Model::ocam &&
             (table.has("width") || table.has("height"))) {
    config.size = size(table);
  }
  table.done();
}

void read_mount(TomlTable table, CameraConfig& config) {
  Mount& mount = config.mount;
  mount.height = table.required_number("height_m", {0.05, 100});
  if (looks_all_round(config.model)) {
    mount.forward = side(table, "forward", "image up");
    mount.left = side(table, "left", "image left");
    if (along_rows(mount.forward) == along_rows(mount.left)) {
      table.fail("left", "lies on the same axis as forward",
                 "one is up or down, the other left or right");
    }
    mount.centre_looks_down = table.choice("centre", "down", {"down", "up"}) == "down";
  } else if (table.has("horizon_row")) {
    if (table.has("pitch_deg")) {
      table.fail("horizon_row", "stands beside pitch_deg", "give one of the two");
    }
    config.horizon_row = table.required_number("horizon_row", {-20000, 40000});
  }
  mount.roll = radians(table.number("roll_deg", 0, {-180, 180}));
  mount.pitch = radians(table.number("pitch_deg", 0, {-90, 90}));
  mount.yaw = radians(table.number("yaw_deg", 0, {-360, 360}));
  table.done();
}

void read_panorama(TomlTable table, CameraConfig& config) {
  config.columns = table.integer("columns", 1440, {64, 16384});
  if (config.columns % 8 != 0) table.fail("columns", "is not a multiple of 8", "for instance 1440");
  config.elevation_top = radians(table.number("elevation_top_deg", 27, {-30, 80}));
  config.range_min = table.number("range_min_m", 0.9, {0.05, 1000});
  table.done();
}

void read_search(TomlTable table, CameraConfig& config) {
  config.search.range = table.interval("range_m", {1.0, 8.0}, {0.05, 1000});
  config.search.diameter = table.interval("diameter_m", {0.2, 0.8}, {0.01, 20});
  table.done();
}

constexpr int kMostRows = 8192;
constexpr int kMostPixels = 1 << 24;

void require_sensible_size(const TomlTable& root, const PanoramaGeometry& panorama) {
  if (panorama.rows >= 16 && panorama.rows <= kMostRows &&
      panorama.rows <= kMostPixels / panorama.columns) {
    return;
  }
  root.fail("panorama",
            "has " + std::to_string(panorama.rows) + " rows of " +
                std::to_string(panorama.columns) + " pixels",
            "elevation_top_deg, range_min_m, columns and mount.height_m must give 16 to " +
                std::to_string(kMostRows) + " rows and at most " + std::to_string(kMostPixels) +
                " pixels");
}

}  // namespace

std::string_view name_of(CameraConfig::Model model) {
  return std::ranges::find(kModels, model, &NamedModel::model)->name;
}

bool looks_all_round(CameraConfig::Model model) { return model != CameraConfig::Model::pinhole; }

CameraConfig parse_camera_config(std::string_view text, const std::string& file) {
  TomlTable root(parse_toml(text, file), file);
  CameraConfig config;
  read_camera(root.table("camera"), config);
  read_mount(root.table("mount"), config);
  read_panorama(root.table("panorama"), config);
  read_search(root.table("search"), config);
  root.done();
  require_sensible_size(root, panorama_of(config));
  return config;
}

PanoramaGeometry panorama_of(const CameraConfig& config) {
  return full_panorama(config.columns, config.elevation_top, config.range_min, config.mount.height);
}

}  // namespace bole
