#include "capture/v4l2/format.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/errors.h"
#include "capture/frame_source.h"

namespace bole {
namespace {

struct KnownFormat {
  std::uint32_t fourcc;
  PixelFormat pixels;
};

// The least work first: green is read from luma or raw pixels as they are, colours take more bus
// and memory, and JPEG must be decoded.
constexpr std::array kKnownFormats = {
    KnownFormat{V4L2_PIX_FMT_NV12, PixelFormat::nv12},
    KnownFormat{V4L2_PIX_FMT_NV12M, PixelFormat::nv12},
    KnownFormat{V4L2_PIX_FMT_GREY, PixelFormat::grey},
    KnownFormat{V4L2_PIX_FMT_YUYV, PixelFormat::yuyv},
    KnownFormat{V4L2_PIX_FMT_UYVY, PixelFormat::uyvy},
    KnownFormat{V4L2_PIX_FMT_SRGGB8, PixelFormat::rggb},
    KnownFormat{V4L2_PIX_FMT_SGRBG8, PixelFormat::grbg},
    KnownFormat{V4L2_PIX_FMT_SGBRG8, PixelFormat::gbrg},
    KnownFormat{V4L2_PIX_FMT_SBGGR8, PixelFormat::bggr},
    KnownFormat{V4L2_PIX_FMT_RGB24, PixelFormat::rgb24},
    KnownFormat{V4L2_PIX_FMT_BGR24, PixelFormat::bgr24},
    KnownFormat{V4L2_PIX_FMT_MJPEG, PixelFormat::mjpeg},
    KnownFormat{V4L2_PIX_FMT_JPEG, PixelFormat::mjpeg},
};

bool is_multiplanar(v4l2_buf_type type) { return type == V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE; }

v4l2_format wish(v4l2_buf_type type, std::uint32_t fourcc, ImageSize size) {
  v4l2_format format{};
  format.type = type;
  if (is_multiplanar(type)) {
    format.fmt.pix_mp.width = static_cast<__u32>(size.width);
    format.fmt.pix_mp.height = static_cast<__u32>(size.height);
    format.fmt.pix_mp.pixelformat = fourcc;
    format.fmt.pix_mp.field = V4L2_FIELD_NONE;
  } else {
    format.fmt.pix.width = static_cast<__u32>(size.width);
    format.fmt.pix.height = static_cast<__u32>(size.height);
    format.fmt.pix.pixelformat = fourcc;
    format.fmt.pix.field = V4L2_FIELD_NONE;
  }
  return format;
}

// What the driver made of it. Some drivers give no stride for formats where it is evident.
V4l2Format granted(const v4l2_format& driver) {
  V4l2Format format;
  format.type = static_cast<v4l2_buf_type>(driver.type);
  int stride = 0;
  if (is_multiplanar(format.type)) {
    const v4l2_pix_format_mplane& pix = driver.fmt.pix_mp;
    format.fourcc = pix.pixelformat;
    format.layout.size = {static_cast<int>(pix.width), static_cast<int>(pix.height)};
    format.layout.memory_planes = pix.num_planes;
    stride = static_cast<int>(pix.plane_fmt[0].bytesperline);
    format.layout.strides[1] = static_cast<int>(pix.plane_fmt[1].bytesperline);
  } else {
    const v4l2_pix_format& pix = driver.fmt.pix;
    format.fourcc = pix.pixelformat;
    format.layout.size = {static_cast<int>(pix.width), static_cast<int>(pix.height)};
    stride = static_cast<int>(pix.bytesperline);
  }
  format.layout.pixels = pixel_format_of(format.fourcc).value_or(PixelFormat::grey);
  format.layout.strides[0] =
      std::max(stride, packed_row_bytes(format.layout.pixels, format.layout.size.width));
  if (format.layout.memory_planes < 2 || format.layout.strides[1] == 0)
    format.layout.strides[1] = format.layout.strides[0];
  return format;
}

std::chrono::nanoseconds period_of(const v4l2_fract& fraction) {
  if (fraction.numerator == 0 || fraction.denominator == 0) return std::chrono::nanoseconds(0);
  return std::chrono::nanoseconds(
      std::llround(1e9 * fraction.numerator / static_cast<double>(fraction.denominator)));
}

// Asks for the rate, where one is wanted, and returns the period that the driver has chosen.
std::chrono::nanoseconds negotiate_rate(const V4l2Device& device, v4l2_buf_type type,
                                        double rate_hz) {
  v4l2_streamparm parameters{};
  parameters.type = type;
  if (device.ask(VIDIOC_G_PARM, &parameters) != 0) return std::chrono::nanoseconds(0);
  v4l2_captureparm& capture = parameters.parm.capture;
  if (rate_hz > 0 && (capture.capability & V4L2_CAP_TIMEPERFRAME) != 0) {
    capture.timeperframe = {1000, static_cast<__u32>(std::llround(1000 * rate_hz))};
    if (device.ask(VIDIOC_S_PARM, &parameters) != 0) device.ask(VIDIOC_G_PARM, &parameters);
  }
  return period_of(capture.timeperframe);
}

// nullopt when the driver gives another format or size than was asked for.
std::optional<V4l2Format> try_format(const V4l2Device& device, v4l2_buf_type type,
                                     std::uint32_t fourcc, const CameraSettings& settings,
                                     std::string& offered) {
  v4l2_format driver = wish(type, fourcc, settings.size);
  const int error = device.ask(VIDIOC_S_FMT, &driver);
  if (error == EBUSY) throw CaptureError("is in use by another program");
  if (error != 0) {
    offered = "refuses " + fourcc_text(fourcc) + ": " + error_text(error);
    return std::nullopt;
  }
  V4l2Format format = granted(driver);
  const __u32 field = is_multiplanar(type) ? driver.fmt.pix_mp.field : driver.fmt.pix.field;
  const bool whole_frames =
      field == V4L2_FIELD_NONE || field == V4L2_FIELD_ANY || field == V4L2_FIELD_INTERLACED;
  if (format.fourcc != fourcc || format.layout.size != settings.size || !whole_frames) {
    offered = "offers " + fourcc_text(format.fourcc) + " " + shown(format.layout.size) +
              (whole_frames ? "" : " in single fields");
    return std::nullopt;
  }
  format.period = negotiate_rate(device, type, settings.frame_rate);
  return format;
}

bool reaches(const V4l2Format& format, double rate_hz) {
  constexpr double kTolerance = 0.9;
  return rate_hz <= 0 || format.period.count() == 0 ||
         1e9 / static_cast<double>(format.period.count()) >= kTolerance * rate_hz;
}

// The fourccs that are wanted and on offer, in the order of kKnownFormats.
std::vector<std::uint32_t> candidates(const V4l2Device& device, v4l2_buf_type type,
                                      std::optional<PixelFormat> wanted) {
  const std::vector<std::uint32_t> offered = list_formats(device, type);
  std::vector<std::uint32_t> ordered;
  for (const KnownFormat& known : kKnownFormats) {
    const bool on_offer = std::ranges::find(offered, known.fourcc) != offered.end();
    if (on_offer && (!wanted || known.pixels == *wanted)) ordered.push_back(known.fourcc);
  }
  if (ordered.empty()) {
    throw CaptureError(wanted ? "has no format " + std::string(name(*wanted))
                              : "has no format that can be read");
  }
  return ordered;
}

}  // namespace

std::optional<PixelFormat> pixel_format_of(std::uint32_t fourcc) {
  const auto* const found = std::ranges::find(kKnownFormats, fourcc, &KnownFormat::fourcc);
  if (found == kKnownFormats.end()) return std::nullopt;
  return found->pixels;
}

std::string fourcc_text(std::uint32_t fourcc) {
  std::string text;
  for (const int shift : {0, 8, 16, 24}) {
    const auto c = static_cast<char>((fourcc >> shift) & 0x7f);
    text += c > ' ' && c < 0x7f ? c : '.';
  }
  return text;
}

std::vector<std::uint32_t> list_formats(const V4l2Device& device, v4l2_buf_type type) {
  std::vector<std::uint32_t> fourccs;
  v4l2_fmtdesc description{};
  description.type = type;
  while (device.ask(VIDIOC_ENUM_FMT, &description) == 0) {
    if (pixel_format_of(description.pixelformat)) fourccs.push_back(description.pixelformat);
    ++description.index;
  }
  return fourccs;
}

V4l2Format negotiate_format(const V4l2Device& device, const CameraSettings& settings) {
  const v4l2_buf_type type = device.capture_type();
  std::optional<V4l2Format> best;
  std::optional<V4l2Format> last;
  std::string offered;
  for (const std::uint32_t fourcc : candidates(device, type, settings.format)) {
    last = try_format(device, type, fourcc, settings, offered);
    if (last && (!best || last->period < best->period)) best = last;
    if (last && reaches(*last, settings.frame_rate)) return *last;
  }
  if (!best) {
    throw CaptureError(offered + ", the calibration is for " + shown(settings.size));
  }
  best = try_format(device, type, best->fourcc, settings, offered);
  if (!best) throw CaptureError("does not keep to the format it has given");
  return *best;
}

}  // namespace bole
