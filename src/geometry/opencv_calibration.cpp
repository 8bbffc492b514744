#include "geometry/opencv_calibration.h"

#include <algorithm>
#include <functional>
#include <optional>

#include <yaml-cpp/yaml.h>

namespace bole {
namespace {

class Reader {
 public:
  Reader(const YAML::Node& root, const std::string& file) : root_(root), file_(file) {}

  bool has(const char* key) const { return root_[key].IsDefined(); }

  std::vector<double> matrix(const char* key, std::size_t low, std::size_t high) const {
    auto values =
        read<std::vector<double>>(key, [](const YAML::Node& node) { return node["data"]; });
    if (values.size() < low || values.size() > high) {
      const std::string most = std::to_string(high);
      fail(key, "has " + std::to_string(values.size()) + " numbers",
           "needs " + (low == high ? most : std::to_string(low) + " to " + most));
    }
    return values;
  }

  // The sample programs write a number, a cv::Mat becomes a matrix of one.
  double number(const char* key) const {
    return has(key) && root_[key].IsMap() ? matrix(key, 1, 1).front() : read<double>(key);
  }

  int side(const char* key) const {
    const int pixels = read<int>(key);
    if (pixels < 1 || pixels > 20000) {
      fail(key, "is " + std::to_string(pixels), "must be from 1 to 20000");
    }
    return pixels;
  }

  std::string word(const char* key) const { return read<std::string>(key); }

  [[noreturn]] void fail(const char* key, const std::string& problem,
                         const std::string& remedy) const {
    throw ConfigError(file_, key, problem, remedy);
  }

 private:
  template <class Value, class Part = std::identity>
  Value read(const char* key, const Part& part = {}) const {
    if (!has(key)) fail(key, "is missing", "run the calibration again or restore the file");
    try {
      return part(root_[key]).template as<Value>();
    } catch (const YAML::Exception&) {
      fail(key, "cannot be read", "must be as OpenCV or ROS writes it");
    }
  }

  const YAML::Node& root_;
  const std::string& file_;
};

struct Said {
  const char* key;
  const char* model;
};

// OpenCV's sample program notes a fisheye, ROS's names the distortion.
std::optional<Said> model_of(const Reader& reader) {
  if (reader.has("xi")) return Said{"xi", "omnidir"};
  if (reader.has("fisheye_model")) {
    return Said{"fisheye_model", reader.word("fisheye_model") == "0" ? "pinhole" : "fisheye"};
  }
  if (reader.has("distortion_model")) {
    const std::string name = reader.word("distortion_model");
    const bool fisheye = name == "equidistant" || name == "fisheye";
    return Said{"distortion_model", fisheye ? "fisheye" : "pinhole"};
  }
  return std::nullopt;
}

CameraMatrix matrix_of(const Reader& reader) {
  const auto k = reader.matrix("camera_matrix", 9, 9);
  if (k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1) {
    reader.fail("camera_matrix", "is no camera matrix", "must be fx s cx, 0 fy cy, 0 0 1");
  }
  return {
      .focal_x = k[0], .focal_y = k[4], .centre_column = k[2], .centre_row = k[5], .skew = k[1]};
}

// OpenCV's sample program for omnidirectional cameras does not write it.
ImageSize size_of(const Reader& reader, ImageSize said) {
  if (!reader.has("image_width") && !reader.has("image_height")) {
    if (said.width > 0) return said;
    reader.fail("image_width", "is missing", "give width and height in camera.toml's [camera]");
  }
  const ImageSize size{reader.side("image_width"), reader.side("image_height")};
  if (said.width > 0 && said != size) {
    reader.fail("image_width", "is of " + shown(size) + " pixels, camera.toml of " + shown(said),
                "calibrate at the size that is used, and leave width and height out");
  }
  return size;
}

}  // namespace

OpencvCalibration parse_opencv_calibration(std::string_view text, const std::string& file,
                                           const ExpectedCalibration& expected, ImageSize size) {
  if (text.starts_with("<?xml")) {
    throw ConfigError(file, "", "is XML", "let OpenCV write a file whose name ends in .yml");
  }
  // OpenCV's first line, "%YAML:1.0", is not a YAML directive.
  if (text.starts_with('%')) text.remove_prefix(std::min(text.find('\n'), text.size()));
  try {
    const YAML::Node root = YAML::Load(std::string(text));
    const Reader reader(root, file);
    const auto said = model_of(reader);
    if (said && said->model != expected.model) {
      reader.fail(said->key, std::string("is of a camera of the model ") + said->model,
                  std::string("set camera.model = \"") + said->model +
                      "\" in camera.toml, or name another calibration");
    }
    return {.matrix = matrix_of(reader),
            .distortion = reader.matrix("distortion_coefficients", expected.fewest_coefficients,
                                        expected.most_coefficients),
            .xi = expected.model == "omnidir" ? reader.number("xi") : 0,
            .size = size_of(reader, size)};
  } catch (const YAML::Exception& error) {
    throw ConfigError(file, "", "is not OpenCV's calibration: " + error.msg,
                      "needs image_width, image_height, camera_matrix, distortion_coefficients");
  }
}

}  // namespace bole
