#pragma once

#include <libcamera/camera.h>
#include <libcamera/framebuffer_allocator.h>

#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "base/wakeup.h"
#include "capture/buffer_layout.h"
#include "capture/device_memory.h"
#include "capture/frame_source.h"
#include "capture/libcamera/usb_camera.h"

namespace bole {

/// A camera that streams, from its start to its end: buffers, mapped once, with a request each.
/// libcamera's thread only posts what it has completed; frames share in owning the session, so
/// that their pixels stay readable when it has ended.
class LibcameraSession : public FrameBuffers {
 public:
  static constexpr int kMaxBuffers = 32;

  /// A completed request, as libcamera's thread saw it.
  struct Completed {
    int index = 0;
    bool good = false;
    std::uint32_t sequence = 0;
    std::int64_t stamp_ns = 0;  ///< CLOCK_MONOTONIC
    std::array<std::size_t, 2> bytes{};
  };

  /// `camera`: acquired and configured for one stream, laid out as `layout`; released at the end.
  /// Throws CaptureError.
  LibcameraSession(std::shared_ptr<libcamera::Camera> camera, libcamera::Stream* stream,
                   const BufferLayout& layout, const libcamera::ControlList& controls);
  LibcameraSession(const LibcameraSession&) = delete;
  LibcameraSession& operator=(const LibcameraSession&) = delete;
  ~LibcameraSession() override;

  /// Readable once something was posted, until taken.
  int fd() const { return posted_.fd(); }
  /// Moves what was posted to `completed`; how many.
  int take(std::span<Completed, kMaxBuffers> completed);
  /// Whether the camera is gone, by the kernel's word or libcamera's.
  bool gone() const { return disconnected_ || unplug_watch_.unplugged(); }
  /// Ready for POLLPRI when the kernel says so; fd() when libcamera does.
  int unplug_fd() const { return unplug_watch_.fd(); }
  /// Whether libcamera has still to notice that the camera is gone. Until then it must not be
  /// stopped: libcamera 0.0.3 asserts that all requests come back, which they do not.
  bool libcamera_lags() const { return !disconnected_ && unplug_watch_.unplugged(); }
  /// Waits until libcamera has noticed, at most `timeout`.
  void await_libcamera(std::chrono::milliseconds timeout) const;
  int count() const { return static_cast<int>(requests_.size()); }

  /// The filled buffer as an image, made visible to the processor; nullopt when it is too short.
  std::optional<ImageView> view(const Completed& completed) const;
  void give_back(int index) noexcept override;
  /// Sets this exposure with the next request that is queued.
  void expose(int exposure_us) { exposure_us_ = exposure_us; }
  /// Ends the stream and gives the camera free. Requests that an unplugged camera leaves hanging
  /// are not waited for.
  void stop() noexcept;

 private:
  // A buffer's memory areas in this process.
  struct Area {
    libcamera::SharedFD fd;
    DeviceMemory mapped;
    std::size_t offset = 0;  // of the area in what is mapped
  };
  using Areas = std::array<Area, 2>;

  void on_completed(libcamera::Request* request);
  void on_disconnected();
  void prepare(const libcamera::FrameBuffer& buffer);
  void start(libcamera::Stream* stream, const libcamera::ControlList& controls);
  void end() noexcept;

  std::shared_ptr<libcamera::Camera> camera_;
  const UnplugWatch unplug_watch_;
  const BufferLayout layout_;
  std::unique_ptr<libcamera::FrameBufferAllocator> allocator_;
  std::vector<std::unique_ptr<libcamera::Request>> requests_;
  std::vector<Areas> buffers_;
  std::atomic<int> exposure_us_ = 0;

  Wakeup posted_;
  std::atomic<bool> disconnected_ = false;
  std::mutex posted_mutex_;  // of the two below; taken in libcamera's thread
  std::array<Completed, kMaxBuffers> waiting_;
  int waiting_count_ = 0;

  std::mutex running_mutex_;  // never taken in libcamera's thread, which stop() waits for
  bool running_ = false;
};

}  // namespace bole
