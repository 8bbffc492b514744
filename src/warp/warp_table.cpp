#include "warp/warp_table.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/checksum.h"
#include "base/errors.h"
#include "base/files.h"
#include "warp/warp_table_file.h"

namespace bole {
namespace {

constexpr std::size_t kAlignment = 64;
constexpr std::size_t kLargestFile = std::size_t{1} << 30;
constexpr std::size_t kCrcStart = offsetof(WarpTableHead, bytes);
constexpr std::string_view kRemedy = "build it anew: bolectl lut build";

std::size_t aligned(std::size_t size) { return (size + kAlignment - 1) / kAlignment * kAlignment; }

template <class T>
void append(std::vector<std::byte>& bytes, const std::vector<T>& section) {
  bytes.resize(aligned(bytes.size()));
  const auto raw = std::as_bytes(std::span(section));
  bytes.insert(bytes.end(), raw.begin(), raw.end());
}

// Takes one section after the other, as append() laid them.
class Sections {
 public:
  explicit Sections(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <class T>
  std::optional<std::span<const T>> next(std::size_t count) {
    start_ = aligned(start_);
    if (start_ > bytes_.size() || (bytes_.size() - start_) / sizeof(T) < count) return std::nullopt;
    const auto* const first = reinterpret_cast<const T*>(bytes_.data() + start_);
    start_ += count * sizeof(T);
    return std::span(first, count);
  }
  void skip(std::size_t size) { start_ += size; }
  bool at_end() const { return start_ == bytes_.size(); }

 private:
  std::span<const std::byte> bytes_;
  std::size_t start_ = 0;
};

bool plausible(const WarpTableHead& head) {
  const auto within = [](int value, int low, int high) { return value >= low && value <= high; };
  return within(head.image_width, 2, 32768) && within(head.image_height, 2, 32768) &&
         within(head.columns, 1, 32768) && within(head.first_column, 0, head.columns - 1) &&
         within(head.width, 1, head.columns) && within(head.rows, 1, 32768) &&
         std::isfinite(head.top_tangent);
}

// No entry may lead out of the image, whoever wrote the file.
bool inside_image(const WarpTable& table) {
  const int last_row = table.image_size().height - 2, last_column = table.image_size().width - 2;
  const auto entries = table.entries();
  for (std::size_t t = 0; t < table.tiles().size(); ++t) {
    const WarpTile& tile = table.tiles()[t];
    if (tile.last_row > last_row || tile.last_column > last_column) return false;
    for (const WarpEntry entry : entries.subspan(t * kTilePixels, kTilePixels)) {
      if (tile.row + (entry >> (16 + kWarpBits)) > tile.last_row ||
          tile.column + ((entry & 0xffff) >> kWarpBits) > tile.last_column) {
        return false;
      }
    }
  }
  return std::ranges::all_of(table.strays(),
                             [&](const WarpStray& stray) {
                               return stray.tile < table.tiles().size() &&
                                      stray.pixel < kTilePixels && stray.row <= last_row &&
                                      stray.column <= last_column && stray.row_step < kWarpSteps &&
                                      stray.column_step < kWarpSteps;
                             }) &&
         std::ranges::is_sorted(table.strays(), {}, &WarpStray::tile);
}

bool rows_exist(const SeenMap& seen, int rows) {
  return std::ranges::all_of(seen.columns, [rows](SeenRows column) { return column.last <= rows; });
}

}  // namespace

std::vector<std::byte> warp_table_bytes(WarpTableContent content) {
  std::vector<std::byte> bytes(sizeof(WarpTableHead));
  append(bytes, content.tiles);
  append(bytes, content.entries);
  append(bytes, content.strays);
  append(bytes, content.seen);
  append(bytes, content.columns);
  content.head.bytes = bytes.size();
  content.head.strays = static_cast<std::uint32_t>(content.strays.size());
  std::memcpy(bytes.data(), &content.head, sizeof content.head);
  content.head.crc = crc32(std::span(bytes).subspan(kCrcStart));
  std::memcpy(bytes.data(), &content.head, sizeof content.head);
  return bytes;
}

WarpTable::WarpTable(std::vector<std::byte> bytes, const std::string& file, std::uint32_t digest)
    : bytes_(std::move(bytes)) {
  const auto require = [&file](bool condition, const char* problem) {
    if (!condition) throw ConfigError(file, "", problem, std::string(kRemedy));
  };
  const std::span<const std::byte> all = bytes_;
  WarpTableHead head;
  require(all.size() >= sizeof head, "is too short for a warp table");
  std::memcpy(&head, all.data(), sizeof head);
  require(head.magic == WarpTableHead::kMagic, "is not a warp table");
  require(head.version == WarpTableHead::kVersion, "is a warp table of another version");
  require(head.bytes == all.size(), "is a truncated warp table");
  require(head.crc == crc32(all.subspan(kCrcStart)), "is a damaged warp table");
  require(head.digest == digest,
          "is a warp table of another camera, or of this one before a change");
  require(plausible(head), "is not a possible warp table");

  digest_ = head.digest;
  image_size_ = {head.image_width, head.image_height};
  panorama_ = {head.columns, head.first_column, head.width, head.rows, head.top_tangent};
  const auto tile_count =
      static_cast<std::size_t>(strips()) * static_cast<std::size_t>(tiles_per_strip());
  const auto pixels = static_cast<std::size_t>(head.rows) * static_cast<std::size_t>(head.width);
  Sections sections(all);
  sections.skip(sizeof head);
  const auto tiles = sections.next<WarpTile>(tile_count);
  const auto entries = sections.next<WarpEntry>(tile_count * kTilePixels);
  const auto strays = sections.next<WarpStray>(head.strays);
  const auto seen = sections.next<std::uint8_t>(pixels);
  const auto columns = sections.next<SeenRows>(static_cast<std::size_t>(head.width));
  require(tiles && entries && strays && seen && columns && sections.at_end(),
          "is not a possible warp table");
  tiles_ = *tiles;
  entries_ = *entries;
  strays_ = *strays;
  seen_ = {*seen, *columns};
  require(inside_image(*this) && rows_exist(seen_, head.rows), "leads out of the image");
}

WarpTable WarpTable::load(const std::filesystem::path& path, std::uint32_t digest) {
  return {read_file(path, kLargestFile), path, digest};
}

WarpTable WarpTable::parse(std::vector<std::byte> bytes, const std::string& file,
                           std::uint32_t digest) {
  return {std::move(bytes), file, digest};
}

void WarpTable::store(const std::filesystem::path& path) const {
  write_file_atomically(path, bytes_);
}

Pixel WarpTable::source(int row, int column) const {
  const std::size_t tile = row / kTileRows * tiles_per_strip() + column / kTileColumns;
  const std::size_t pixel = row % kTileRows * kTileColumns + column % kTileColumns;
  const auto stray = std::ranges::find_if(
      strays_, [&](const WarpStray& s) { return s.tile == tile && s.pixel == pixel; });
  if (stray != strays_.end()) {
    return {stray->row + stray->row_step / double{kWarpSteps},
            stray->column + stray->column_step / double{kWarpSteps}};
  }
  const WarpEntry entry = entries_[tile * kTilePixels + pixel];
  return {tiles_[tile].row + (entry >> 16) / double{kWarpSteps},
          tiles_[tile].column + (entry & 0xffff) / double{kWarpSteps}};
}

}  // namespace bole
