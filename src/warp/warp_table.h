#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/panorama_view.h"
#include "warp/camera_files.h"

namespace bole {

/// The panorama is cut into tiles, stored strip by strip, from the left in each strip; the last
/// ones may stick out of the panorama on the right and below.
inline constexpr int kTileRows = 8;
inline constexpr int kTileColumns = 16;
inline constexpr int kTilePixels = kTileRows * kTileColumns;

/// Source positions are kept in steps of 1 / kWarpSteps pixel.
inline constexpr int kWarpBits = 6;
inline constexpr int kWarpSteps = 1 << kWarpBits;

/// Where the entries of a tile count from, and the last source pixel that any of them starts from.
struct WarpTile {
  std::uint16_t row, column;
  std::uint16_t last_row, last_column;
};

/// Source position of one panorama pixel: the block of two by two source pixels whose first is
/// (tile.row + rows, tile.column + columns), and how far into it, in steps. Packed in 32 bits:
/// column 10.6 in the low half, row 10.6 in the high.
using WarpEntry = std::uint32_t;

/// A pixel whose source lies too far from its tile's for an entry, as a filled one's may.
struct WarpStray {
  std::uint32_t tile;
  std::uint16_t pixel;  ///< within the tile, row by row
  std::uint16_t column_step, row_step;
  std::uint16_t column, row;
  std::uint16_t unused;
};

/// For every pixel of the kept panorama where in the raw image it lies, and whether the camera sees
/// it. The table does not depend on the frame's pixel format.
///
/// A pixel is *seen* when the four source pixels around its position (rounded to 1 / kWarpSteps
/// pixel) lie in the image and none is masked. Any other pixel carries the position of the nearest
/// seen one of its column, the upper one where two are as near: filling costs nothing at run time.
/// A column without any takes over the nearest column that has some; its SeenRows are empty.
class WarpTable {
 public:
  /// Reads a stored table; what becomes of the file afterwards is nothing to it. Throws ConfigError
  /// when the file is damaged, of another version, or was built for another camera than the one
  /// with `digest`.
  static WarpTable load(const std::filesystem::path& path, std::uint32_t digest);
  /// As load, from the file's bytes.
  static WarpTable parse(std::vector<std::byte> bytes, const std::string& file,
                         std::uint32_t digest);
  // What a copy would show is the first one's bytes.
  WarpTable(const WarpTable&) = delete;
  WarpTable& operator=(const WarpTable&) = delete;
  WarpTable(WarpTable&&) = default;
  WarpTable& operator=(WarpTable&&) = default;
  ~WarpTable() = default;

  /// Replaces the file at `path` by this table, in one step.
  void store(const std::filesystem::path& path) const;

  const PanoramaGeometry& panorama() const { return panorama_; }
  SeenMap seen() const { return seen_; }
  ImageSize image_size() const { return image_size_; }
  std::uint32_t digest() const { return digest_; }
  /// The table as it stands in a file.
  std::span<const std::byte> bytes() const { return bytes_; }

  int strips() const { return (panorama_.rows + kTileRows - 1) / kTileRows; }
  int tiles_per_strip() const { return (panorama_.width + kTileColumns - 1) / kTileColumns; }
  /// Bytes of a panorama row as the kernels write it: whole tiles.
  int padded_width() const { return tiles_per_strip() * kTileColumns; }
  std::span<const WarpTile> tiles() const { return tiles_; }
  /// kTilePixels a tile, row by row.
  std::span<const WarpEntry> entries() const { return entries_; }
  /// In the order of their tiles.
  std::span<const WarpStray> strays() const { return strays_; }

  /// Where pixel (row, column) of the kept panorama takes its value from.
  Pixel source(int row, int column) const;

 private:
  WarpTable(std::vector<std::byte> bytes, const std::string& file, std::uint32_t digest);
  friend WarpTable build_warp_table(const Camera& camera);

  std::vector<std::byte> bytes_;
  PanoramaGeometry panorama_;
  ImageSize image_size_;
  std::uint32_t digest_ = 0;
  SeenMap seen_;
  std::span<const WarpTile> tiles_;
  std::span<const WarpEntry> entries_;
  std::span<const WarpStray> strays_;
};

/// Builds the table of a camera. The whole turn is kept unless a quarter of it or more, in one
/// piece, is never seen: then the shortest arc that holds all seen columns. Throws ConfigError when
/// the panorama would see nothing at all.
WarpTable build_warp_table(const Camera& camera);

}  // namespace bole
