#include "video_modes.h"

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <utility>

namespace hil {
namespace {

// Most formats are named by a FOURCC followed by these twelve bytes.
constexpr std::array<uint8_t, 16> guid_of(const char (&name)[5]) {
  return {static_cast<uint8_t>(name[0]),
          static_cast<uint8_t>(name[1]),
          static_cast<uint8_t>(name[2]),
          static_cast<uint8_t>(name[3]),
          0x00,
          0x00,
          0x10,
          0x00,
          0x80,
          0x00,
          0x00,
          0xaa,
          0x00,
          0x38,
          0x9b,
          0x71};
}

// Microsoft's MEDIASUBTYPE_RGB24, which uvcvideo reads as BGR3.
constexpr std::array<uint8_t, 16> kGuidBgr24 = {0x7d, 0xeb, 0x36, 0xe4, 0x4f, 0x52, 0xce, 0x11,
                                                0x9f, 0x53, 0x00, 0x20, 0xaf, 0x0b, 0xa7, 0x70};

// Those that uvcvideo of Linux 6.1 maps to a format the daemon reads. It knows no RGB3.
constexpr PixelFormat kPixelFormats[] = {
    {"YUYV", guid_of("YUY2"), 16}, {"UYVY", guid_of("UYVY"), 16},
    {"NV12", guid_of("NV12"), 12}, {"GREY", guid_of("Y800"), 8},
    {"BA81", guid_of("BA81"), 8},  {"GBRG", guid_of("GBRG"), 8},
    {"GRBG", guid_of("GRBG"), 8},  {"RGGB", guid_of("RGGB"), 8},
    {"BGR3", kGuidBgr24, 24},      {"MJPG", {}, 0},
};

const PixelFormat* find_pixel_format(std::string_view fourcc) {
  const auto* found = std::ranges::find(kPixelFormats, fourcc, &PixelFormat::fourcc);
  return found == std::end(kPixelFormats) ? nullptr : found;
}

std::vector<std::span<const uint8_t>> split_raw(std::span<const uint8_t> bytes, size_t frame_size) {
  std::vector<std::span<const uint8_t>> frames;
  for (size_t at = 0; at + frame_size <= bytes.size(); at += frame_size) {
    frames.push_back(bytes.subspan(at, frame_size));
  }
  return frames;
}

// A JPEG ends at its End Of Image marker, ff d9, which entropy-coded data cannot contain.
std::vector<std::span<const uint8_t>> split_jpegs(std::span<const uint8_t> bytes) {
  constexpr std::array<uint8_t, 2> kEndOfImage = {0xff, 0xd9};
  std::vector<std::span<const uint8_t>> frames;
  while (true) {
    const auto marker = std::ranges::search(bytes, kEndOfImage);
    if (marker.empty()) return frames;
    const auto size = static_cast<size_t>(marker.end() - bytes.begin());
    frames.push_back(bytes.first(size));
    bytes = bytes.subspan(size);
  }
}

FrameSize load_frames(const PixelFormat& format, unsigned width, unsigned height,
                      const std::string& path) {
  constexpr size_t kLargestFile = size_t{256} << 20;
  std::vector<std::byte> file = bole::read_file(path, kLargestFile);
  const std::span bytes(reinterpret_cast<const uint8_t*>(file.data()), file.size());
  const size_t raw_size = size_t{width} * height * format.bits_per_pixel / 8;
  auto frames = format.is_jpeg() ? split_jpegs(bytes) : split_raw(bytes, raw_size);
  if (frames.empty()) throw std::runtime_error(path + ": holds no whole frame");
  const auto largest = std::ranges::max(frames, {}, &std::span<const uint8_t>::size);
  return {width, height, static_cast<uint32_t>(largest.size()), std::move(file), std::move(frames)};
}

}  // namespace

std::vector<VideoFormat> load_video_modes(std::span<const std::string> arguments) {
  std::vector<VideoFormat> formats;
  for (const std::string& argument : arguments) {
    char fourcc[5] = "";
    unsigned width = 0;
    unsigned height = 0;
    int path_start = 0;
    std::sscanf(argument.c_str(), "%4[^:]:%ux%u:%n", fourcc, &width, &height, &path_start);
    const PixelFormat* pixel_format = find_pixel_format(fourcc);
    if (path_start == 0 || pixel_format == nullptr) {
      throw std::runtime_error(argument + ": not FOURCC:WIDTHxHEIGHT:FILE");
    }
    auto format = std::ranges::find(formats, pixel_format, &VideoFormat::pixel_format);
    if (format == formats.end()) {
      format = formats.insert(formats.end(), VideoFormat{pixel_format, {}});
    }
    format->sizes.push_back(
        load_frames(*pixel_format, width, height, argument.substr(size_t(path_start))));
  }
  if (formats.empty()) throw std::runtime_error("a camera needs at least one mode");
  return formats;
}

}  // namespace hil
