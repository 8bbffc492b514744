#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "base/image.h"
#include "warp/camera_files.h"
#include "warp/warp_table.h"

namespace bole::bench {

/// The sizes that every benchmark is run with, as in "warp/1280x960".
inline constexpr ImageSize kSizes[] = {{640, 480}, {1280, 960}, {2592, 1944}};

/// What the benchmarks share: calib/example scaled to a size, its table, and one frame of a made-up
/// wood, whose green plane (row by row) frames of any format are made of.
struct Scene {
  Camera camera;
  WarpTable table;
  std::vector<std::byte> green;

  /// The frame as a camera of that format would deliver it, tightly packed; red, blue and chroma
  /// are made from green, MJPEG has quality 90.
  std::vector<std::byte> frame(PixelFormat format) const;
};

/// A scene of that size; `change`, if any, is made to the camera's configuration beforehand.
Scene make_scene(ImageSize size, const std::function<void(CameraConfig&)>& change = {});

/// The unchanged scene of that size, made at the first call.
const Scene& scene(ImageSize size);

/// Does the work of one frame. A function of its own, never inlined: scripts/bench counts the
/// instructions inside of it, apart from those that prepare the benchmark.
template <class Work>
[[gnu::noinline]] void one_frame(const Work& work) {
  work();
}

/// "<subject>/<width>x<height>".
std::string name_of(const std::string& subject, ImageSize size);

}  // namespace bole::bench
