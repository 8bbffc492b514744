#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "detect/tree.h"
#include "evaluate/drawing.h"
#include "warp/camera_files.h"
#include "warp/warp_table.h"

namespace bole {

/// The pictures in which a person checks a list of trees against its frame.

/// A rectangle on a trunk, and what is written under its foot.
struct TrunkMark {
  double bearing = 0;         ///< radians
  double angular_width = 0;   ///< radians
  double base_elevation = 0;  ///< radians
  Colour colour;
  std::vector<std::string> labels;
};

/// A detected tree in the colour of its score, with its score and its range.
TrunkMark mark_of(const Tree& tree);

/// The panorama, twice its size, with the horizon, the ground's lines at whole metres, the
/// robot's sides named and the marked trunks' rectangles from the foot up.
cv::Mat3b draw_panorama(const Camera& camera, const WarpTable& table, const cv::Mat3b& picture,
                        std::span<const TrunkMark> marks);

/// The raw image with the same lines and rectangles, un-warped onto it, and the robot's forward and
/// left named.
cv::Mat3b draw_raw(const Camera& camera, const cv::Mat3b& picture, std::span<const Tree> trees);

/// The ground seen from above, forward up and left to the left: feet and sizes of the trunks to
/// scale, with the uncertainty of their range, on circles at whole metres.
cv::Mat3b draw_polar_map(const Search& search, std::span<const Tree> trees);

/// Writes a PNG file. Throws ConfigError when that fails.
void write_picture(const std::filesystem::path& file, const cv::Mat3b& picture);

/// Makes the folder and sees to it that it can be written. Throws ConfigError naming `option`.
void prepare_folder(const std::string& option, const std::filesystem::path& folder);

/// Before anything is written: prepares the folder, and sees to it that no
/// two images' pictures would have one name. Throws ConfigError naming --annotate.
void prepare_annotations(const std::filesystem::path& folder, std::span<const std::string> images);

/// Writes the first two as PNG: <folder>/<name>_panorama.png, _raw.png. Throws ConfigError when
/// that fails.
void write_frame_annotations(const std::filesystem::path& folder, const std::string& name,
                             const Camera& camera, const WarpTable& table, const cv::Mat3b& picture,
                             std::span<const Tree> trees);

/// Writes all three as PNG: <folder>/<name>_panorama.png, _raw.png, _map.png. Throws
/// ConfigError when that fails.
void write_annotations(const std::filesystem::path& folder, const std::string& name,
                       const Camera& camera, const WarpTable& table, const cv::Mat3b& picture,
                       std::span<const Tree> trees);

}  // namespace bole
