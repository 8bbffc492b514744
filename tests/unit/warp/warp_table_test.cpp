#include "warp/warp_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <string>

#include "base/errors.h"
#include "support/config_problem.h"
#include "unit/warp/test_cameras.h"
#include "warp/table_cache.h"

namespace bole {
namespace {

using ::testing::HasSubstr;

std::optional<Pixel> direct_look(const Camera& camera, const WarpTable& table, int row,
                                 int column) {
  return camera.model->pixel_from_ray(transposed(camera.robot_from_camera) *
                                      table.panorama().ray(row, column));
}

bool is_seen(const WarpTable& table, int row, int column) {
  return table.seen().pixels[static_cast<std::size_t>(row * table.panorama().width + column)] != 0;
}

std::string problem_of(const std::vector<std::byte>& bytes, std::uint32_t digest) {
  return test::config_problem([&] { WarpTable::parse(bytes, "some.table", digest); });
}

std::vector<std::byte> copy_of(std::span<const std::byte> bytes) {
  return {bytes.begin(), bytes.end()};
}

TEST(WarpTable, SeenPixelsPointToWhereTheCameraModelSeesThem) {
  const test::TemporaryFolder folder;
  const Camera camera = load_camera(write_small_camera(folder));
  const WarpTable table = build_warp_table(camera);
  ASSERT_TRUE(table.panorama().wraps());
  int seen = 0;
  for (int i = 0; i < table.panorama().rows; ++i) {
    for (int j = 0; j < table.panorama().width; ++j) {
      if (!is_seen(table, i, j)) continue;
      const auto pixel = direct_look(camera, table, i, j);
      ASSERT_TRUE(pixel);
      EXPECT_NEAR(table.source(i, j).row, pixel->row, 0.5 / kWarpSteps + 1e-9);
      EXPECT_NEAR(table.source(i, j).column, pixel->column, 0.5 / kWarpSteps + 1e-9);
      ++seen;
    }
  }
  EXPECT_GT(seen, table.panorama().rows * table.panorama().width * 9 / 10);
}

TEST(WarpTable, APixelIsSeenWhenItsFourSourcePixelsAreInTheImageAndUnmasked) {
  const test::TemporaryFolder folder;
  std::vector<std::uint8_t> mask(320 * 240, 1);
  for (int i = 0; i < 320 * 240; i += 37) mask[static_cast<std::size_t>(i)] = 0;  // ragged
  const Camera camera = load_camera(write_small_camera(folder, mask));
  const WarpTable table = build_warp_table(camera);
  for (int i = 0; i < table.panorama().rows; ++i) {
    for (int j = 0; j < table.panorama().width; ++j) {
      const auto pixel = direct_look(camera, table, i, j);
      ASSERT_TRUE(pixel);
      const int row = static_cast<int>(std::floor(pixel->row + 0.5 / kWarpSteps));
      const int column = static_cast<int>(std::floor(pixel->column + 0.5 / kWarpSteps));
      bool expected = row >= 0 && column >= 0 && row + 1 < 240 && column + 1 < 320;
      for (int k = 0; expected && k < 4; ++k) {
        expected = mask[static_cast<std::size_t>((row + k / 2) * 320 + column + k % 2)] != 0;
      }
      EXPECT_EQ(is_seen(table, i, j), expected) << i << " " << j;
    }
  }
}

TEST(WarpTable, AnUnseenPixelTakesTheNearestSeenOneOfItsColumnTheUpperOnTies) {
  const test::TemporaryFolder folder;
  std::vector<std::uint8_t> mask(320 * 240, 1);
  for (std::size_t i = 0; i < mask.size(); i += 7) mask[i] = 0;
  const WarpTable table = build_warp_table(load_camera(write_small_camera(folder, mask)));
  const int rows = table.panorama().rows;
  int filled = 0;
  for (int j = 0; j < table.panorama().width; ++j) {
    for (int i = 0; i < rows; ++i) {
      if (is_seen(table, i, j)) continue;
      int nearest = -1;
      for (int d = 1; d < rows && nearest < 0; ++d) {
        if (i - d >= 0 && is_seen(table, i - d, j)) {
          nearest = i - d;
        } else if (i + d < rows && is_seen(table, i + d, j)) {
          nearest = i + d;
        }
      }
      if (nearest < 0) continue;
      EXPECT_EQ(table.source(i, j).row, table.source(nearest, j).row);
      EXPECT_EQ(table.source(i, j).column, table.source(nearest, j).column);
      ++filled;
    }
  }
  EXPECT_GT(filled, 1000);
}

TEST(WarpTable, SeenRowsSpanTheSeenPixelsOfEachColumn) {
  const test::TemporaryFolder folder;
  std::vector<std::uint8_t> mask(320 * 240, 1);
  std::fill_n(mask.begin(), 320 * 100, std::uint8_t{0});
  const WarpTable table = build_warp_table(load_camera(write_small_camera(folder, mask)));
  int empty = 0;
  for (int j = 0; j < table.panorama().width; ++j) {
    const SeenRows column = table.seen().columns[static_cast<std::size_t>(j)];
    empty += column.empty() ? 1 : 0;
    for (int i = 0; i < table.panorama().rows; ++i) {
      EXPECT_TRUE(!is_seen(table, i, j) || (i >= column.first && i < column.last));
    }
    if (column.empty()) continue;
    EXPECT_TRUE(is_seen(table, column.first, j));
    EXPECT_TRUE(is_seen(table, column.last - 1, j));
  }
  EXPECT_LT(empty, table.panorama().width);
}

TEST(WarpTable, ACameraThatLooksAheadKeepsTheArcItSees) {
  const test::TemporaryFolder folder;
  const WarpTable table = build_warp_table(load_camera(write_pinhole(folder)));
  EXPECT_NEAR(table.panorama().width, 120, 2);  // 60 of 360 degrees of 720 columns
  EXPECT_FALSE(table.panorama().wraps());
  EXPECT_NEAR(table.panorama().bearing_of_column((table.panorama().width - 1) / 2.0), 0, 0.005);
  EXPECT_FALSE(table.seen().columns.front().empty());
  EXPECT_FALSE(table.seen().columns.back().empty());
}

TEST(WarpTable, TheHorizonRowOfAPhotographIsThePanoramasHorizon) {
  const test::TemporaryFolder folder;
  const WarpTable table = build_warp_table(load_camera(write_pinhole(folder)));
  const int row = static_cast<int>(std::lround(table.panorama().horizon_row()));
  const double off = row - table.panorama().horizon_row();
  const double focal_px = 80 / std::tan(M_PI / 6);
  EXPECT_NEAR(table.source(row, table.panorama().width / 2).row,
              50 + off * focal_px / table.panorama().focal(), 0.05);
}

// It would point into the table that it was copied from.
static_assert(!std::is_copy_constructible_v<WarpTable>);

TEST(WarpTable, StoredAndLoadedIsTheSame) {
  const test::TemporaryFolder folder;
  const Camera camera = load_camera(write_small_camera(folder));
  const WarpTable built = build_warp_table(camera);
  built.store(folder.path() / "new" / "table");
  const WarpTable loaded = WarpTable::load(folder.path() / "new" / "table", camera.digest);
  EXPECT_EQ(loaded.panorama(), built.panorama());
  EXPECT_EQ(loaded.image_size(), built.image_size());
  EXPECT_EQ(copy_of(loaded.bytes()), copy_of(built.bytes()));
}

TEST(WarpTable, DoesNotCareWhatBecomesOfItsFile) {
  const test::TemporaryFolder folder;
  const Camera camera = load_camera(write_small_camera(folder));
  const WarpTable built = build_warp_table(camera);
  built.store(folder.path() / "table");
  const WarpTable loaded = WarpTable::load(folder.path() / "table", camera.digest);
  // In place, as cp does it.
  std::ofstream(folder.path() / "table", std::ios::trunc) << "another";
  EXPECT_EQ(copy_of(loaded.bytes()), copy_of(built.bytes()));
}

TEST(WarpTable, OneDamagedBitAnywhereIsRefused) {
  const test::TemporaryFolder folder;
  const Camera camera = load_camera(write_small_camera(folder));
  std::vector<std::byte> bytes = copy_of(build_warp_table(camera).bytes());
  for (std::size_t at = 0; at < bytes.size(); at += at < 64 ? 1 : 4099) {
    for (const int bit : {0, 7}) {
      bytes[at] ^= std::byte(1 << bit);
      EXPECT_NE(problem_of(bytes, camera.digest), "none") << at;
      bytes[at] ^= std::byte(1 << bit);
    }
  }
  EXPECT_EQ(problem_of(bytes, camera.digest), "none");
}

TEST(WarpTable, TruncatedForeignOrOtherVersionsAreRefusedInOneLine) {
  const test::TemporaryFolder folder;
  const Camera camera = load_camera(write_small_camera(folder));
  const std::vector<std::byte> good = copy_of(build_warp_table(camera).bytes());
  EXPECT_THAT(problem_of(good, camera.digest + 1), HasSubstr("another camera"));
  std::vector<std::byte> bytes = good;
  bytes[8] = std::byte{99};
  EXPECT_THAT(problem_of(bytes, camera.digest), HasSubstr("another version"));
  bytes = good;
  bytes.pop_back();
  EXPECT_THAT(problem_of(bytes, camera.digest), HasSubstr("truncated"));
  bytes.resize(63);
  EXPECT_THAT(problem_of(bytes, camera.digest), HasSubstr("too short"));
  EXPECT_THAT(problem_of(bytes, camera.digest), HasSubstr("some.table: "));
}

TEST(WarpTable, AMaskThatLeavesNothingOfThePanoramaIsRefused) {
  const test::TemporaryFolder folder;
  std::vector<std::uint8_t> mask(320 * 240, 0);
  mask[0] = 255;
  const Camera camera = load_camera(write_small_camera(folder, mask));
  EXPECT_THROW(build_warp_table(camera), ConfigError);
}

TEST(TableCache, BuildsOnceThenMapsAndBuildsAnewWhatIsDamaged) {
  const test::TemporaryFolder folder;
  const Camera camera = load_camera(write_small_camera(folder));
  const auto cache = folder.path() / "cache";
  EXPECT_TRUE(load_or_build_warp_table(camera, cache).built);
  const CachedTable again = load_or_build_warp_table(camera, cache);
  EXPECT_FALSE(again.built);
  EXPECT_EQ(again.trouble, "");
  for (const auto& file : std::filesystem::directory_iterator(cache)) {
    std::filesystem::resize_file(file.path(), 1000);
  }
  EXPECT_TRUE(load_or_build_warp_table(camera, cache).built);
  EXPECT_FALSE(load_or_build_warp_table(camera, cache).built);
}

TEST(TableCache, KeepsTheNewestTablesAndWhateverElseIsThere) {
  const test::TemporaryFolder folder;
  const Camera camera = load_camera(write_small_camera(folder));
  const auto cache = folder.path() / "cache";
  std::filesystem::create_directory(cache);
  const auto now = std::filesystem::file_time_type::clock::now();
  const auto put = [&](const std::string& name, int hours_ago) {
    std::ofstream(cache / name) << "other";
    std::filesystem::last_write_time(cache / name, now - std::chrono::hours(hours_ago));
  };
  for (int k = 1; k <= 9; ++k) put("warp-0000000" + std::to_string(k) + ".table", k);
  put("notes.txt", 99);
  EXPECT_TRUE(load_or_build_warp_table(camera, cache).built);
  EXPECT_FALSE(load_or_build_warp_table(camera, cache).built);
  EXPECT_TRUE(std::filesystem::exists(cache / "warp-00000007.table"));
  EXPECT_FALSE(std::filesystem::exists(cache / "warp-00000008.table"));
  EXPECT_FALSE(std::filesystem::exists(cache / "warp-00000009.table"));
  EXPECT_TRUE(std::filesystem::exists(cache / "notes.txt"));
}

TEST(TableCache, WithoutAPlaceToKeepItTheTableIsStillThere) {
  const test::TemporaryFolder folder;
  const Camera camera = load_camera(write_small_camera(folder));
  const auto no_folder = folder.write("file", "in the way");
  const CachedTable table = load_or_build_warp_table(camera, no_folder);
  EXPECT_TRUE(table.built);
  EXPECT_NE(table.trouble, "");
  EXPECT_EQ(table.table.panorama().columns, 360);
}

}  // namespace
}  // namespace bole
