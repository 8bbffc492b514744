#include "capture/v4l2/stream.h"

#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "base/errors.h"

namespace bole {
namespace {

[[noreturn]] void fail(const std::string& what, int error) {
  throw CaptureError(what + ": " + error_text(error));
}

int request(const V4l2Device& device, v4l2_buf_type type, int wanted, int& granted) {
  v4l2_requestbuffers buffers{};
  buffers.count = static_cast<__u32>(wanted);
  buffers.type = type;
  buffers.memory = V4L2_MEMORY_MMAP;
  const int error = device.call(VIDIOC_REQBUFS, &buffers);
  granted = static_cast<int>(buffers.count);
  return error;
}

}  // namespace

V4l2Buffers::V4l2Buffers(V4l2Device device, const V4l2Format& format, int wanted)
    : device_(std::move(device)), format_(format) {
  if (format_.layout.memory_planes > 2) throw CaptureError("spreads a frame over too many planes");
  int granted = 0;
  const int error = request(device_, format_.type, wanted, granted);
  if (error == EBUSY) throw CaptureError("is in use by another program");
  if (error != 0) fail("gives no buffers", error);
  constexpr int kLeast = 2;
  if (granted < kLeast) throw CaptureError("gives too few buffers");
  for (int i = 0; i < granted; ++i) map(i);
  for (int i = 0; i < granted; ++i) {
    if (const int refused = queue(i)) fail("takes no buffer", refused);
  }
  int type = format_.type;
  if (const int refused = device_.ask(VIDIOC_STREAMON, &type)) fail("does not start", refused);
  streaming_ = true;
}

V4l2Buffers::~V4l2Buffers() { stop(); }

v4l2_buffer V4l2Buffers::describe(int index,
                                  std::array<v4l2_plane, VIDEO_MAX_PLANES>& planes) const {
  v4l2_buffer buffer{};
  buffer.index = static_cast<__u32>(index);
  buffer.type = format_.type;
  buffer.memory = V4L2_MEMORY_MMAP;
  if (multiplanar()) {
    buffer.m.planes = planes.data();
    buffer.length = static_cast<__u32>(planes.size());
  }
  return buffer;
}

void V4l2Buffers::map(int index) {
  std::array<v4l2_plane, VIDEO_MAX_PLANES> planes{};
  v4l2_buffer buffer = describe(index, planes);
  if (const int error = device_.ask(VIDIOC_QUERYBUF, &buffer)) fail("describes no buffer", error);
  Areas& areas = buffers_.emplace_back();
  for (int plane = 0; plane < format_.layout.memory_planes; ++plane) {
    const auto at = static_cast<std::size_t>(plane);
    const std::size_t length = multiplanar() ? planes.at(at).length : buffer.length;
    const auto offset =
        static_cast<off_t>(multiplanar() ? planes.at(at).m.mem_offset : buffer.m.offset);
    areas.at(at) = DeviceMemory(device_.fd(), offset, length, PROT_READ | PROT_WRITE);
  }
}

int V4l2Buffers::queue(int index) noexcept {
  std::array<v4l2_plane, VIDEO_MAX_PLANES> planes{};
  v4l2_buffer buffer = describe(index, planes);
  if (multiplanar()) buffer.length = static_cast<__u32>(format_.layout.memory_planes);
  return device_.call(VIDIOC_QBUF, &buffer);
}

int V4l2Buffers::dequeue(v4l2_buffer& buffer, std::array<v4l2_plane, VIDEO_MAX_PLANES>& planes) {
  buffer = describe(0, planes);
  const int error = device_.call(VIDIOC_DQBUF, &buffer);
  if (error == 0 && buffer.index >= buffers_.size()) return EIO;
  return error;
}

std::optional<ImageView> V4l2Buffers::view(const v4l2_buffer& buffer) const {
  const Areas& areas = buffers_.at(buffer.index);
  std::array<std::span<const std::byte>, 2> filled;
  for (std::size_t i = 0; i < filled.size(); ++i) {
    const std::span<const std::byte> area = areas.at(i).bytes();
    if (area.empty()) continue;
    const std::size_t begin = multiplanar() ? buffer.m.planes[i].data_offset : 0;
    const std::size_t end = multiplanar() ? buffer.m.planes[i].bytesused : buffer.bytesused;
    if (begin > end || end > area.size()) return std::nullopt;
    filled.at(i) = area.subspan(begin, end - begin);
  }
  return view_buffer(format_.layout, filled);
}

void V4l2Buffers::give_back(int index) noexcept {
  const std::lock_guard lock(mutex_);
  // A refusal means that the camera is gone, which the next dequeue() tells.
  if (streaming_) queue(index);
}

void V4l2Buffers::stop() noexcept {
  const std::lock_guard lock(mutex_);
  if (!streaming_) return;
  streaming_ = false;
  int type = format_.type;
  device_.call(VIDIOC_STREAMOFF, &type);
  // Sets the driver's buffers free. A held frame keeps the device's memory (and, to the kernel, the
  // device) until it is dropped, but no longer keeps others from using the camera.
  int none = 0;
  request(device_, format_.type, 0, none);
  device_.close();
}

}  // namespace bole
