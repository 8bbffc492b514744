#include "evaluate/annotate.h"

#include <unistd.h>

#include <cerrno>
#include <map>
#include <system_error>

#include "base/errors.h"
#include "base/files.h"
#include "base/png_file.h"
#include "evaluate/image_detector.h"

namespace bole {

void write_picture(const std::filesystem::path& file, const cv::Mat3b& picture) {
  write_file_atomically(file, encode_png(view_of(picture)));
}

void prepare_folder(const std::string& option, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error && ::access(folder.c_str(), W_OK | X_OK) != 0) {
    error = {errno, std::generic_category()};
  }
  if (error) {
    throw ConfigError(option, "", folder.string() + " cannot be written: " + error.message(),
                      "give a folder that may be written");
  }
}

void prepare_annotations(const std::filesystem::path& folder, std::span<const std::string> images) {
  std::map<std::string, std::string> by_name;
  for (const std::string& image : images) {
    const auto [other, is_new] = by_name.emplace(std::filesystem::path(image).stem(), image);
    if (is_new) continue;
    std::string problem = image;
    problem.append(" would be drawn under the name of ").append(other->second);
    throw ConfigError("--annotate", "", problem,
                      "give images whose names differ before the ending");
  }
  prepare_folder("--annotate", folder);
}

void write_frame_annotations(const std::filesystem::path& folder, const std::string& name,
                             const Camera& camera, const WarpTable& table, const cv::Mat3b& picture,
                             std::span<const Tree> trees) {
  std::vector<TrunkMark> marks;
  for (const Tree& tree : trees) marks.push_back(mark_of(tree));
  write_picture(folder / (name + "_panorama.png"), draw_panorama(camera, table, picture, marks));
  write_picture(folder / (name + "_raw.png"), draw_raw(camera, picture, trees));
}

void write_annotations(const std::filesystem::path& folder, const std::string& name,
                       const Camera& camera, const WarpTable& table, const cv::Mat3b& picture,
                       std::span<const Tree> trees) {
  write_frame_annotations(folder, name, camera, table, picture, trees);
  write_picture(folder / (name + "_map.png"), draw_polar_map(camera.config.search, trees));
}

}  // namespace bole
