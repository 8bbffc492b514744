#include "warp/warper.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "support/guarded_buffer.h"
#include "support/vector_targets.h"
#include "unit/warp/test_cameras.h"
#include "warp/bad_frame.h"

namespace bole {
namespace {

constexpr std::array kRawFormats = {PixelFormat::grey, PixelFormat::yuyv, PixelFormat::uyvy,
                                    PixelFormat::nv12, PixelFormat::rggb, PixelFormat::grbg,
                                    PixelFormat::gbrg, PixelFormat::bggr, PixelFormat::rgb24,
                                    PixelFormat::bgr24};

void fill_with_noise(std::span<std::byte> bytes) {
  std::minstd_rand random(7);
  std::ranges::generate(bytes, [&] { return std::byte(random() >> 8); });
}

using Panorama = std::vector<std::uint8_t>;

Panorama copy_of(const PanoramaView& view) {
  Panorama pixels;
  for (int i = 0; i < view.geometry->rows; ++i) {
    pixels.insert(pixels.end(), view.row(i), view.row(i) + view.geometry->width);
  }
  return pixels;
}

Panorama plain_warp(const WarpTable& table, const SampledImage& image) {
  const int rows = table.panorama().rows, stride = table.padded_width();
  std::vector<std::uint8_t> buffer(static_cast<std::size_t>(rows * stride));
  warp_rows_plain(table, image, 0, rows, {buffer.data(), stride});
  return copy_of({&table.panorama(), buffer.data(), stride});
}

// A camera that sees its whole image, to the last pixel of each border.
std::filesystem::path write_wide_pinhole(const test::TemporaryFolder& folder) {
  return folder.write("wide.toml", R"(
[camera]
model = "pinhole"
horizontal_fov_deg = 70
width = 64
height = 48
[mount]
height_m = 2
[panorama]
columns = 1024
elevation_top_deg = 40
range_min_m = 2
)");
}

TEST(Warper, KernelsEqualThePlainOneInEveryFormatAndTouchNothingOutside) {
  const test::TemporaryFolder folder;
  for (const auto& file : {write_small_camera(folder), write_wide_pinhole(folder)}) {
    const WarpTable table = build_warp_table(load_camera(file));
    Warper warper(table);
    for (const PixelFormat format : kRawFormats) {
      for (const auto tight : {GuardedBuffer::Tight::start, GuardedBuffer::Tight::end}) {
        SCOPED_TRACE(name(format));
        const GuardedBuffer buffer(packed_frame_bytes(format, table.image_size()), tight);
        fill_with_noise(buffer.bytes());
        const auto image = view_packed(format, table.image_size(), buffer.bytes());
        ASSERT_TRUE(image);
        const Panorama expected = plain_warp(table, warper.open(*image));
        for_each_vector_target([&](const char* target) {
          EXPECT_EQ(copy_of(warper.warp(*image)), expected) << target;
        });
      }
    }
  }
}

// What the kernels are compared on above takes each of the ways through them.
TEST(WarpWindows, HalvesOfTilesFitASmallWindowALargeOneOrTwo) {
  const test::TemporaryFolder folder;
  const WarpTable table = build_warp_table(load_camera(write_small_camera(folder)));
  const WarpWindows windows(table);
  int small = 0, large = 0, two = 0;
  for (std::size_t t = 0; t < table.tiles().size(); ++t) {
    if (!windows.tile(t).fits) continue;
    for (const WarpWindows::Half& half : windows.tile(t).halves) {
      ++(half.small ? small : half.left == half.right ? large : two);
    }
  }
  EXPECT_GT(small, 100);
  EXPECT_GT(large, 100);
  EXPECT_GT(two, 10);
}

TEST(Warper, ReadsRowsThatAreFartherApartThanTheyAreLong) {
  const test::TemporaryFolder folder;
  const WarpTable table = build_warp_table(load_camera(write_small_camera(folder)));
  Warper warper(table);
  std::vector<std::byte> packed(320 * 240 * 2);
  fill_with_noise(packed);
  // The last row ends with its last pixel, as a driver's buffer may.
  const GuardedBuffer padded(239 * 704 + 640, GuardedBuffer::Tight::end);
  for (std::size_t i = 0; i < 240; ++i) {
    std::copy_n(packed.begin() + static_cast<std::ptrdiff_t>(i * 640), 640,
                padded.bytes().begin() + static_cast<std::ptrdiff_t>(i * 704));
  }
  const Panorama expected =
      copy_of(warper.warp(*view_packed(PixelFormat::yuyv, {320, 240}, packed)));
  const ImageView view{PixelFormat::yuyv, {320, 240}, {Plane{padded.bytes(), 704}, Plane{}}};
  EXPECT_EQ(copy_of(warper.warp(view)), expected);
}

TEST(Warper, StripsJoinToTheWholePanorama) {
  const test::TemporaryFolder folder;
  const WarpTable table = build_warp_table(load_camera(write_small_camera(folder)));
  Warper warper(table);
  std::vector<std::byte> bytes(320 * 240);
  fill_with_noise(bytes);
  const ImageView image = *view_packed(PixelFormat::grey, {320, 240}, bytes);
  const Panorama whole = copy_of(warper.warp(image));
  const SampledImage opened = warper.open(image);
  const int rows = table.panorama().rows, stride = table.padded_width();
  std::vector<std::uint8_t> buffer(static_cast<std::size_t>(rows * stride));
  for (int first = 0; first < rows; first += 3 * kTileRows) {
    warper.warp_rows(opened, first, std::min(rows, first + 3 * kTileRows),
                     {buffer.data() + first * stride, stride});
  }
  EXPECT_EQ(copy_of({&table.panorama(), buffer.data(), stride}), whole);
}

// Sources far from their tile's, as ragged masks make them, take another way through the kernels.
TEST(Warper, PixelsFilledFromFarAwayHaveTheirSourcesValue) {
  const test::TemporaryFolder folder;
  folder.write("big.txt", "3 -600 0 6e-4\n2 1000 800\n1250 1250\n1 0 0\n2500 2500\n");
  std::vector<std::uint8_t> mask(2500 * 2500, 0);
  std::minstd_rand random(3);
  for (std::size_t row = 0; row < 2500; ++row) {
    for (std::size_t column = 0; column < 2500; ++column) {
      const bool upper_edge = row < 60;
      const bool beside_the_middle = row > 1150 && row < 1170 && column / 64 % 2 == 0;
      mask[row * 2500 + column] = upper_edge || beside_the_middle ? 255 : 0;
    }
  }
  write_png(folder.path() / "mask.png", {2500, 2500}, mask);
  std::string toml(kSmallCameraToml);
  toml.replace(toml.find("MASK"), 4, "mask = \"mask.png\"");
  toml.replace(toml.find("calib.txt"), 9, "big.txt");
  const WarpTable table = build_warp_table(load_camera(folder.write("big.toml", toml)));
  ASSERT_FALSE(table.strays().empty());
  std::vector<std::byte> bytes(2500 * 2500);
  fill_with_noise(bytes);
  Warper warper(table);
  const PanoramaView view = warper.warp(*view_packed(PixelFormat::grey, {2500, 2500}, bytes));
  const auto at = [&](int row, int column) {
    return std::to_integer<int>(bytes[static_cast<std::size_t>(row * 2500 + column)]);
  };
  for (int i = 0; i < view.geometry->rows; i += 5) {
    for (int j = 0; j < view.geometry->width; ++j) {
      const Pixel source = table.source(i, j);
      const int row = static_cast<int>(source.row), column = static_cast<int>(source.column);
      const double v = source.row - row, u = source.column - column;
      const double expected = (1 - v) * ((1 - u) * at(row, column) + u * at(row, column + 1)) +
                              v * ((1 - u) * at(row + 1, column) + u * at(row + 1, column + 1));
      // Rounded twice, the first time to 1 / 64.
      EXPECT_NEAR(view.row(i)[j], expected, 0.5 + 0.5 / 64 + 1e-9) << i << " " << j;
    }
  }
}

// Its stride does not fit the kernels' 16 bits, its columns in steps do not either.
TEST(Warper, AVeryWideImageIsWarpedToo) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("wide.toml", R"(
[camera]
model = "pinhole"
horizontal_fov_deg = 100
width = 20000
height = 64
[mount]
height_m = 1
[panorama]
columns = 16384
elevation_top_deg = 0.2
range_min_m = 200
)");
  const WarpTable table = build_warp_table(load_camera(file));
  const GuardedBuffer buffer(packed_frame_bytes(PixelFormat::rgb24, {20000, 64}),
                             GuardedBuffer::Tight::end);
  for (std::size_t i = 0; i < buffer.bytes().size(); ++i) {
    buffer.bytes()[i] = std::byte(i % 60000 / 3 * 255 / 20000);  // brighter to the right
  }
  Warper warper(table);
  const PanoramaView view =
      warper.warp(*view_packed(PixelFormat::rgb24, {20000, 64}, buffer.bytes()));
  for (int j = 0; j < view.geometry->width; ++j) {
    EXPECT_NEAR(view.row(10)[j], table.source(10, j).column * 255 / 20000, 1.5);
  }
}

TEST(Warper, GreenOfRgbIsGreenWhateverRedAndBlue) {
  const test::TemporaryFolder folder;
  const WarpTable table = build_warp_table(load_camera(write_small_camera(folder)));
  Warper warper(table);
  std::vector<std::byte> grey(320 * 240), rgb(320 * 240 * 3);
  fill_with_noise(rgb);
  for (std::size_t i = 0; i < grey.size(); ++i) grey[i] = rgb[3 * i + 1];
  const Panorama expected = copy_of(warper.warp(*view_packed(PixelFormat::grey, {320, 240}, grey)));
  for (const PixelFormat format : {PixelFormat::rgb24, PixelFormat::bgr24}) {
    EXPECT_EQ(copy_of(warper.warp(*view_packed(format, {320, 240}, rgb))), expected);
  }
}

TEST(Warper, BayerGreenIsKeptAndCompletedFromItsNeighbours) {
  const test::TemporaryFolder folder;
  const WarpTable table = build_warp_table(load_camera(write_small_camera(folder)));
  Warper warper(table);
  // Red and blue are 255; green grows evenly to the right and down.
  for (const PixelFormat format :
       {PixelFormat::rggb, PixelFormat::grbg, PixelFormat::gbrg, PixelFormat::bggr}) {
    const bool green_first = format == PixelFormat::grbg || format == PixelFormat::gbrg;
    std::vector<std::byte> bytes(320 * 240);
    const auto green = [](int i, int j) { return (i + j) / 4; };
    for (int i = 0; i < 240; ++i) {
      for (int j = 0; j < 320; ++j) {
        const bool is_green = ((i + j) % 2 == 0) == green_first;
        bytes[static_cast<std::size_t>(i * 320 + j)] = std::byte(is_green ? green(i, j) : 255);
      }
    }
    const SampledImage opened = warper.open(*view_packed(format, {320, 240}, bytes));
    for (int i = 1; i < 239; ++i) {
      for (int j = 1; j < 319; ++j) {
        const auto value =
            std::to_integer<int>(opened.bytes[static_cast<std::size_t>(i * opened.stride + j)]);
        ASSERT_NEAR(value, green(i, j), 1) << name(format) << " " << i << " " << j;
      }
    }
  }
}

TEST(Warper, RefusesFramesThatDoNotFit) {
  const test::TemporaryFolder folder;
  const WarpTable table = build_warp_table(load_camera(write_small_camera(folder)));
  Warper warper(table);
  std::vector<std::byte> bytes(640 * 480 * 2);
  EXPECT_THROW(warper.warp(*view_packed(PixelFormat::yuyv, {640, 480}, bytes)), BadFrame);
  ImageView image = *view_packed(PixelFormat::yuyv, {320, 240}, bytes);
  image.planes[0].bytes = image.planes[0].bytes.first(320 * 240 * 2 - 1);
  EXPECT_THROW(warper.warp(image), BadFrame);
  image = *view_packed(PixelFormat::yuyv, {320, 240}, bytes);
  image.planes[0].stride = 639;
  EXPECT_THROW(warper.warp(image), BadFrame);
}

}  // namespace
}  // namespace bole
