#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "base/errors.h"
#include "warp/warp_table.h"
#include "warp/warp_table_file.h"

namespace bole {
namespace {

// A source position in steps of 1 / kWarpSteps pixel; row < 0: the pixel is not seen.
struct Position {
  std::int32_t row = -1, column = -1;
  bool seen() const { return row >= 0; }
};

// The positions of a panorama's pixels, row by row.
struct Field {
  int rows, width;
  std::vector<Position> positions;

  Field(int rows_, int width_)
      : rows(rows_),
        width(width_),
        positions(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(width_)) {}
  Position& at(int row, int column) {
    return positions[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                     static_cast<std::size_t>(column)];
  }
};

bool unmasked(const Camera& camera, int row, int column) {
  if (camera.mask.empty()) return true;
  const auto width = static_cast<std::size_t>(camera.model->image_size().width);
  const std::uint8_t* const first =
      &camera.mask[static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column)];
  return first[0] != 0 && first[1] != 0 && first[width] != 0 && first[width + 1] != 0;
}

Position look(const Camera& camera, const Vec3& robot_ray) {
  const std::optional<Pixel> pixel =
      camera.model->pixel_from_ray(transposed(camera.robot_from_camera) * robot_ray);
  const ImageSize size = camera.model->image_size();
  // Also false for what is not a number; before any rounding, which could overflow.
  if (!pixel || !(pixel->row > -1 && pixel->row < size.height) ||
      !(pixel->column > -1 && pixel->column < size.width)) {
    return {};
  }
  const Position position{static_cast<std::int32_t>(std::floor(pixel->row * kWarpSteps + 0.5)),
                          static_cast<std::int32_t>(std::floor(pixel->column * kWarpSteps + 0.5))};
  if (position.row < 0 || position.column < 0) return {};
  const int row = position.row / kWarpSteps, column = position.column / kWarpSteps;
  if (row > size.height - 2 || column > size.width - 2 || !unmasked(camera, row, column)) return {};
  return position;
}

Field look_around(const Camera& camera, const PanoramaGeometry& panorama) {
  Field field(panorama.rows, panorama.width);
  for (int i = 0; i < field.rows; ++i) {
    for (int j = 0; j < field.width; ++j) field.at(i, j) = look(camera, panorama.ray(i, j));
  }
  return field;
}

std::vector<SeenRows> seen_rows(Field& field) {
  std::vector<SeenRows> columns(static_cast<std::size_t>(field.width));
  for (int i = 0; i < field.rows; ++i) {
    for (int j = 0; j < field.width; ++j) {
      if (!field.at(i, j).seen()) continue;
      SeenRows& column = columns[static_cast<std::size_t>(j)];
      if (column.empty()) column.first = static_cast<std::uint16_t>(i);
      column.last = static_cast<std::uint16_t>(i + 1);
    }
  }
  return columns;
}

struct Arc {
  int first = 0, length = 0;
};

// The longest run of columns, round the seam, that see nothing.
Arc longest_blind_arc(const std::vector<SeenRows>& columns) {
  const int count = static_cast<int>(columns.size());
  Arc longest;
  Arc run;
  for (int j = 0; j < 2 * count; ++j) {
    if (!columns[static_cast<std::size_t>(j < count ? j : j - count)].empty()) {
      run = {};
      continue;
    }
    if (run.length == 0) run.first = j;
    if (++run.length > longest.length && run.length <= count) longest = run;
  }
  return longest;
}

void keep_seen_arc(PanoramaGeometry& panorama, const Arc& blind) {
  if (blind.length * 4 < panorama.columns) return;
  panorama.first_column = (blind.first + blind.length) % panorama.columns;
  panorama.width = panorama.columns - blind.length;
}

// Gives each unseen pixel of a column that sees something the position of its nearest seen pixel.
void fill_column(Field& field, int column) {
  const auto next_seen = [&](int row) {
    while (row < field.rows && !field.at(row, column).seen()) ++row;
    return row;
  };
  int above = -1;
  int below = next_seen(0);
  for (int i = 0; i < field.rows; ++i) {
    if (i == below) {
      above = i;
      below = next_seen(i + 1);
      continue;
    }
    const bool take_above = below == field.rows || (above >= 0 && i - above <= below - i);
    field.at(i, column) = field.at(take_above ? above : below, column);
  }
}

// The nearest column with seen pixels, the left one where two are as near.
int nearest_seeing_column(const std::vector<SeenRows>& columns, int column, bool wraps) {
  const int count = static_cast<int>(columns.size());
  for (int distance = 1; distance < count; ++distance) {
    for (const int candidate : {column - distance, column + distance}) {
      if (!wraps && (candidate < 0 || candidate >= count)) continue;
      const int wrapped = (candidate + count) % count;
      if (!columns[static_cast<std::size_t>(wrapped)].empty()) return wrapped;
    }
  }
  return column;
}

void fill_unseen(Field& field, const std::vector<SeenRows>& columns, bool wraps) {
  for (int j = 0; j < field.width; ++j) {
    if (!columns[static_cast<std::size_t>(j)].empty()) fill_column(field, j);
  }
  for (int j = 0; j < field.width; ++j) {
    if (!columns[static_cast<std::size_t>(j)].empty()) continue;
    const int donor = nearest_seeing_column(columns, j, wraps);
    for (int i = 0; i < field.rows; ++i) field.at(i, j) = field.at(i, donor);
  }
}

constexpr int kReach = 1 << (16 - kWarpBits);  // source pixels that an entry can span

// Packs the positions of one tile's pixels, beginning at panorama pixel (row, column).
class TilePacker {
 public:
  TilePacker(Field& field, WarpTableContent& content) : field_(field), content_(content) {}

  void pack(int row, int column) {
    const Position middle = position(row + kTileRows / 2, column + kTileColumns / 2);
    WarpTile tile{origin(middle.row), origin(middle.column), 0, 0};
    tile.last_row = tile.row;
    tile.last_column = tile.column;
    for (int pixel = 0; pixel < kTilePixels; ++pixel) {
      const Position p = position(row + pixel / kTileColumns, column + pixel % kTileColumns);
      content_.entries.push_back(entry(p, tile, pixel));
    }
    content_.tiles.push_back(tile);
  }

 private:
  // Pixels of a tile that stick out of the panorama repeat the last ones.
  Position position(int row, int column) {
    return field_.at(std::min(row, field_.rows - 1), std::min(column, field_.width - 1));
  }

  static std::uint16_t origin(std::int32_t middle) {
    return static_cast<std::uint16_t>(std::max(0, middle / kWarpSteps - kReach / 2));
  }

  WarpEntry entry(const Position& p, WarpTile& tile, int pixel) {
    const std::int32_t row = p.row - tile.row * kWarpSteps;
    const std::int32_t column = p.column - tile.column * kWarpSteps;
    if (row < 0 || row >= kReach * kWarpSteps || column < 0 || column >= kReach * kWarpSteps) {
      content_.strays.push_back(stray(p, pixel));
      return 0;
    }
    const auto source_row = static_cast<std::uint16_t>(p.row / kWarpSteps);
    const auto source_column = static_cast<std::uint16_t>(p.column / kWarpSteps);
    tile.last_row = std::max(tile.last_row, source_row);
    tile.last_column = std::max(tile.last_column, source_column);
    return static_cast<WarpEntry>(row) << 16 | static_cast<WarpEntry>(column);
  }

  WarpStray stray(const Position& p, int pixel) const {
    return {.tile = static_cast<std::uint32_t>(content_.tiles.size()),
            .pixel = static_cast<std::uint16_t>(pixel),
            .column_step = static_cast<std::uint16_t>(p.column % kWarpSteps),
            .row_step = static_cast<std::uint16_t>(p.row % kWarpSteps),
            .column = static_cast<std::uint16_t>(p.column / kWarpSteps),
            .row = static_cast<std::uint16_t>(p.row / kWarpSteps),
            .unused = 0};
  }

  Field& field_;
  WarpTableContent& content_;
};

WarpTableHead head_of(const Camera& camera, const PanoramaGeometry& panorama) {
  WarpTableHead head;
  head.digest = camera.digest;
  head.image_width = camera.model->image_size().width;
  head.image_height = camera.model->image_size().height;
  head.columns = panorama.columns;
  head.first_column = panorama.first_column;
  head.width = panorama.width;
  head.rows = panorama.rows;
  head.top_tangent = panorama.top_tangent;
  return head;
}

}  // namespace

WarpTable build_warp_table(const Camera& camera) {
  PanoramaGeometry panorama = panorama_of(camera.config);
  Field field = look_around(camera, panorama);
  std::vector<SeenRows> columns = seen_rows(field);
  const Arc blind = longest_blind_arc(columns);
  if (blind.length == panorama.columns) {
    throw ConfigError(camera.file, "panorama", "lies wholly outside of what the camera sees",
                      "check mount, panorama and mask");
  }
  keep_seen_arc(panorama, blind);
  if (!panorama.wraps()) {
    field = look_around(camera, panorama);
    columns = seen_rows(field);
  }
  WarpTableContent content;
  content.head = head_of(camera, panorama);
  std::ranges::transform(field.positions, std::back_inserter(content.seen),
                         [](const Position& p) { return std::uint8_t{p.seen()}; });
  fill_unseen(field, columns, panorama.wraps());
  content.columns = std::move(columns);
  TilePacker packer(field, content);
  for (int row = 0; row < panorama.rows; row += kTileRows) {
    for (int column = 0; column < panorama.width; column += kTileColumns) packer.pack(row, column);
  }
  return {warp_table_bytes(std::move(content)), camera.file, camera.digest};
}

}  // namespace bole
