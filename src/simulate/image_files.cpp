#include "simulate/image_files.h"

#include <turbojpeg.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <stdexcept>

#include "base/png_file.h"

namespace bole::simulate {
namespace {

struct Closer {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using Turbo = std::unique_ptr<void, Closer>;

struct Yuv {
  float y, u, v;
};

// Full-range BT.601.
Yuv yuv_at(const Picture& picture, int row, int column) {
  const std::uint8_t* p =
      picture.rgb.data() + 3 * (static_cast<std::ptrdiff_t>(row) * picture.size.width + column);
  const float r = p[0], g = p[1], b = p[2];
  const float y = 0.299F * r + 0.587F * g + 0.114F * b;
  return {y, 128 + 0.564F * (b - y), 128 + 0.713F * (r - y)};
}

std::byte byte_of(float value) {
  return static_cast<std::byte>(static_cast<int>(std::clamp(value + 0.5F, 0.0F, 255.0F)));
}

std::vector<std::byte> packed_422(const Picture& picture, bool luma_first) {
  std::vector<std::byte> bytes;
  bytes.reserve(picture.rgb.size() / 3 * 2);
  for (int row = 0; row < picture.size.height; ++row) {
    for (int column = 0; column < picture.size.width; column += 2) {
      const Yuv a = yuv_at(picture, row, column), b = yuv_at(picture, row, column + 1);
      const std::byte u = byte_of(0.5F * (a.u + b.u)), v = byte_of(0.5F * (a.v + b.v));
      const std::array<std::byte, 4> group = luma_first
                                                 ? std::array{byte_of(a.y), u, byte_of(b.y), v}
                                                 : std::array{u, byte_of(a.y), v, byte_of(b.y)};
      bytes.insert(bytes.end(), group.begin(), group.end());
    }
  }
  return bytes;
}

void append_luma(const Picture& picture, std::vector<std::byte>& bytes) {
  for (int row = 0; row < picture.size.height; ++row) {
    for (int column = 0; column < picture.size.width; ++column) {
      bytes.push_back(byte_of(yuv_at(picture, row, column).y));
    }
  }
}

std::vector<std::byte> nv12(const Picture& picture) {
  std::vector<std::byte> bytes;
  append_luma(picture, bytes);
  for (int row = 0; row < picture.size.height; row += 2) {
    for (int column = 0; column < picture.size.width; column += 2) {
      float u = 0, v = 0;
      for (const auto [r, c] :
           {std::array{0, 0}, std::array{0, 1}, std::array{1, 0}, std::array{1, 1}}) {
        const Yuv yuv = yuv_at(picture, row + r, column + c);
        u += yuv.u / 4;
        v += yuv.v / 4;
      }
      bytes.push_back(byte_of(u));
      bytes.push_back(byte_of(v));
    }
  }
  return bytes;
}

// `order`: which channel each pixel of a 2 x 2 cell keeps, row by row.
std::vector<std::byte> bayer(const Picture& picture, std::array<int, 4> order) {
  std::vector<std::byte> bytes;
  bytes.reserve(picture.rgb.size() / 3);
  const std::uint8_t* pixel = picture.rgb.data();
  for (int row = 0; row < picture.size.height; ++row) {
    for (int column = 0; column < picture.size.width; ++column, pixel += 3) {
      bytes.push_back(static_cast<std::byte>(pixel[order.at(2 * (row % 2) + column % 2)]));
    }
  }
  return bytes;
}

std::vector<std::byte> interleaved(const Picture& picture, bool red_first) {
  std::vector<std::byte> bytes;
  bytes.reserve(picture.rgb.size());
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      bytes.push_back(static_cast<std::byte>(picture.rgb[i + (red_first ? k : 2 - k)]));
    }
  }
  return bytes;
}

}  // namespace

std::vector<std::byte> encode_png(const Picture& picture) {
  return bole::encode_png(
      view_packed(PixelFormat::rgb24, picture.size, std::as_bytes(std::span(picture.rgb))).value());
}

std::vector<std::byte> encode_jpeg(const Picture& picture, int quality) {
  const Turbo turbo(tjInitCompress());
  unsigned char* data = nullptr;
  unsigned long length = 0;  // NOLINT: the library's type
  const int status =
      tjCompress2(turbo.get(), picture.rgb.data(), picture.size.width, 0, picture.size.height,
                  TJPF_RGB, &data, &length, TJSAMP_420, quality, 0);
  const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owner(data, tjFree);
  if (status != 0) throw std::runtime_error(tjGetErrorStr2(turbo.get()));
  const auto* first = reinterpret_cast<const std::byte*>(data);
  return {first, first + length};
}

Picture through_jpeg(const Picture& picture, int quality) {
  const std::vector<std::byte> bytes = encode_jpeg(picture, quality);
  const Turbo turbo(tjInitDecompress());
  Picture result = picture;
  if (tjDecompress2(turbo.get(), reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(),
                    result.rgb.data(), result.size.width, 0, result.size.height, TJPF_RGB,
                    0) != 0) {
    throw std::runtime_error(tjGetErrorStr2(turbo.get()));
  }
  return result;
}

std::vector<std::byte> encode_raw(const Picture& picture, PixelFormat format) {
  std::vector<std::byte> bytes;
  if (format == PixelFormat::mjpeg) return encode_jpeg(picture, 90);
  std::vector<std::byte> sized(packed_frame_bytes(format, picture.size));
  if (!view_packed(format, picture.size, sized)) {
    throw std::invalid_argument("the image's size does not fit " + std::string(name(format)));
  }
  switch (format) {
    case PixelFormat::grey:
      append_luma(picture, bytes);
      return bytes;
    case PixelFormat::yuyv:
    case PixelFormat::uyvy:
      return packed_422(picture, format == PixelFormat::yuyv);
    case PixelFormat::nv12:
      return nv12(picture);
    case PixelFormat::rggb:
      return bayer(picture, {0, 1, 1, 2});
    case PixelFormat::grbg:
      return bayer(picture, {1, 0, 2, 1});
    case PixelFormat::gbrg:
      return bayer(picture, {1, 2, 0, 1});
    case PixelFormat::bggr:
      return bayer(picture, {2, 1, 1, 0});
    default:
      return interleaved(picture, format == PixelFormat::rgb24);
  }
}

}  // namespace bole::simulate
