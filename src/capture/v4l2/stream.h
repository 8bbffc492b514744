#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <vector>

#include "capture/device_memory.h"
#include "capture/frame_source.h"
#include "capture/v4l2/format.h"

namespace bole {

/// A driver's buffers, mapped once. Frames share in owning them: while one is held, the mapping
/// stays; once the stream has ended, giving a buffer back does nothing.
class V4l2Buffers : public FrameBuffers {
 public:
  /// Asks the driver for `wanted` buffers, maps and queues them all and starts the stream. Throws
  /// CaptureError.
  V4l2Buffers(V4l2Device device, const V4l2Format& format, int wanted);
  V4l2Buffers(const V4l2Buffers&) = delete;
  V4l2Buffers& operator=(const V4l2Buffers&) = delete;
  ~V4l2Buffers() override;

  int count() const { return static_cast<int>(buffers_.size()); }
  int fd() const { return device_.fd(); }
  const V4l2Device& device() const { return device_; }

  /// Fetches a filled buffer. 0, or errno: EAGAIN when there is none.
  int dequeue(v4l2_buffer& buffer, std::array<v4l2_plane, VIDEO_MAX_PLANES>& planes);
  /// The filled buffer as an image; nullopt when it is too short for the format.
  std::optional<ImageView> view(const v4l2_buffer& buffer) const;
  void give_back(int index) noexcept override;
  /// Ends the stream and closes the device.
  void stop() noexcept;

 private:
  using Areas = std::array<DeviceMemory, 2>;  // of one buffer

  void map(int index);
  int queue(int index) noexcept;
  v4l2_buffer describe(int index, std::array<v4l2_plane, VIDEO_MAX_PLANES>& planes) const;
  bool multiplanar() const { return format_.type == V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE; }

  V4l2Device device_;
  const V4l2Format format_;
  std::vector<Areas> buffers_;
  std::mutex mutex_;  // of streaming_, and of the device's end
  bool streaming_ = false;
};

}  // namespace bole
