#include "capture/v4l2/list.h"

#include <algorithm>
#include <string>
#include <utility>

#include "capture/frame_source.h"
#include "capture/v4l2/device.h"
#include "capture/v4l2/format.h"

namespace bole {
namespace {

double rate_of(const v4l2_fract& period) {
  return period.numerator == 0 ? 0 : static_cast<double>(period.denominator) / period.numerator;
}

std::vector<double> list_rates(const V4l2Device& device, std::uint32_t fourcc, ImageSize size) {
  std::vector<double> rates_hz;
  v4l2_frmivalenum interval{};
  interval.pixel_format = fourcc;
  interval.width = static_cast<__u32>(size.width);
  interval.height = static_cast<__u32>(size.height);
  while (device.call(VIDIOC_ENUM_FRAMEINTERVALS, &interval) == 0) {
    if (interval.type != V4L2_FRMIVAL_TYPE_DISCRETE) {  // a range: its ends
      return {rate_of(interval.stepwise.max), rate_of(interval.stepwise.min)};
    }
    rates_hz.push_back(rate_of(interval.discrete));
    ++interval.index;
  }
  return rates_hz;
}

// The sizes of a format; of a range the ends.
std::vector<ImageSize> list_sizes(const V4l2Device& device, std::uint32_t fourcc) {
  const auto size = [](__u32 width, __u32 height) {
    return ImageSize{static_cast<int>(width), static_cast<int>(height)};
  };
  std::vector<ImageSize> sizes;
  v4l2_frmsizeenum entry{};
  entry.pixel_format = fourcc;
  while (device.call(VIDIOC_ENUM_FRAMESIZES, &entry) == 0) {
    if (entry.type != V4L2_FRMSIZE_TYPE_DISCRETE) {
      const v4l2_frmsize_stepwise& range = entry.stepwise;
      return {size(range.min_width, range.min_height), size(range.max_width, range.max_height)};
    }
    sizes.push_back(size(entry.discrete.width, entry.discrete.height));
    ++entry.index;
  }
  return sizes;
}

std::vector<CameraMode> list_modes(const V4l2Device& device, v4l2_buf_type type) {
  std::vector<CameraMode> modes;
  v4l2_fmtdesc format{};
  format.type = type;
  while (device.call(VIDIOC_ENUM_FMT, &format) == 0) {
    const std::uint32_t fourcc = format.pixelformat;
    for (const ImageSize size : list_sizes(device, fourcc)) {
      modes.push_back(
          {fourcc_text(fourcc), pixel_format_of(fourcc), size, list_rates(device, fourcc, size)});
    }
    ++format.index;
  }
  return modes;
}

std::vector<CameraControl> list_controls(const V4l2Device& device) {
  std::vector<CameraControl> controls;
  v4l2_queryctrl query{};
  query.id = V4L2_CTRL_FLAG_NEXT_CTRL;
  while (device.call(VIDIOC_QUERYCTRL, &query) == 0) {
    const bool has_number = query.type == V4L2_CTRL_TYPE_INTEGER ||
                            query.type == V4L2_CTRL_TYPE_BOOLEAN ||
                            query.type == V4L2_CTRL_TYPE_MENU;
    if (has_number && (query.flags & V4L2_CTRL_FLAG_DISABLED) == 0) {
      CameraControl control;
      control.name = reinterpret_cast<const char*>(query.name);
      control.min = query.minimum;
      control.max = query.maximum;
      control.fallback = query.default_value;
      v4l2_control value{query.id, 0};
      if (device.call(VIDIOC_G_CTRL, &value) == 0) control.value = value.value;
      controls.push_back(std::move(control));
    }
    query.id |= V4L2_CTRL_FLAG_NEXT_CTRL;
  }
  return controls;
}

// Throws CaptureError for a node that gives no frames.
CameraInfo describe(const std::filesystem::path& node) {
  const V4l2Device device(node);
  const v4l2_buf_type type = device.capture_type();
  const v4l2_capability capability = device.capability();
  CameraInfo info;
  for (const std::filesystem::path& name : stable_names(node)) info.other_names.push_back(name);
  info.other_names.push_back(node);
  // The most lasting of its names is the one to use.
  info.source = "v4l2:" + info.other_names.front();
  info.other_names.erase(info.other_names.begin());
  const std::string serial = usb_serial(node);
  if (!serial.empty()) info.other_names.push_back(serial);
  info.model = reinterpret_cast<const char*>(capability.card);
  info.driver = reinterpret_cast<const char*>(capability.driver);
  info.modes = list_modes(device, type);
  info.controls = list_controls(device);
  return info;
}

}  // namespace

std::vector<CameraInfo> list_v4l2_cameras() {
  std::vector<CameraInfo> cameras;
  for (const std::filesystem::path& node : v4l2_nodes()) {
    try {
      cameras.push_back(describe(node));
    } catch (const CaptureError&) {  // metadata, an output, or not ours to open
    }
  }
  return cameras;
}

}  // namespace bole
