#include "evaluate/annotate.h"

#include "base/files.h"
#include "base/png_file.h"
#include "evaluate/image_detector.h"

namespace bole {

void write_picture(const std::filesystem::path& file, const cv::Mat3b& picture) {
  write_file_atomically(file, encode_png(view_of(picture)));
}

void write_frame_annotations(const std::filesystem::path& folder, const std::string& name,
                             const Camera& camera, const WarpTable& table, const cv::Mat3b& picture,
                             std::span<const Tree> trees) {
  std::filesystem::create_directories(folder);
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
