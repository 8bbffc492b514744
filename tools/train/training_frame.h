#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <vector>

#include "base/files.h"
#include "geometry/panorama_view.h"

namespace bole::train {

/// A trunk as it lies in a panorama, the robot's unknown tilt included.
struct TrunkTruth {
  float bearing = 0;        ///< of the axis at the ground, radians
  float foot_tangent = 0;   ///< of the elevation of the ground half a diameter before the axis
  float angular_width = 0;  ///< radians
  float range = 0, diameter = 0;
  float visible = 0;  ///< share of the silhouette
};

/// A panorama with its truth, kept in a file so that features can change without drawing anew.
struct TrainingFrame {
  PanoramaGeometry geometry;
  double height = 1;
  std::vector<std::uint8_t> pixels, seen;  ///< rows x width
  std::vector<SeenRows> columns;           ///< width
  std::vector<TrunkTruth> trunks;

  SeenMap seen_map() const { return {seen, columns}; }
  PanoramaView view() const { return {&geometry, pixels.data(), geometry.width}; }

  void save(const std::filesystem::path& file) const {
    std::vector<std::byte> bytes;
    const auto append = [&](const auto& values) {
      const auto raw = std::as_bytes(std::span(values));
      const std::uint64_t size = raw.size();
      const auto head = std::as_bytes(std::span(&size, 1));
      bytes.insert(bytes.end(), head.begin(), head.end());
      bytes.insert(bytes.end(), raw.begin(), raw.end());
    };
    append(std::span(&geometry, 1));
    append(std::span(&height, 1));
    append(pixels);
    append(seen);
    append(columns);
    append(trunks);
    write_file_atomically(file, bytes);
  }

  static TrainingFrame load(const std::filesystem::path& file) {
    const std::vector<std::byte> bytes = read_file(file, std::size_t{1} << 28);
    std::size_t at = 0;
    const auto take = [&](auto& values) {
      using Value = typename std::remove_reference_t<decltype(values)>::value_type;
      std::uint64_t size = 0;
      std::memcpy(&size, bytes.data() + at, sizeof size);
      at += sizeof size;
      values.resize(size / sizeof(Value));
      std::memcpy(values.data(), bytes.data() + at, size);
      at += size;
    };
    TrainingFrame frame;
    std::vector<PanoramaGeometry> geometry;
    std::vector<double> height;
    take(geometry);
    take(height);
    take(frame.pixels);
    take(frame.seen);
    take(frame.columns);
    take(frame.trunks);
    frame.geometry = geometry.at(0);
    frame.height = height.at(0);
    return frame;
  }
};

}  // namespace bole::train
