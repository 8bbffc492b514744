// The camera's bulk endpoint: cuts frames into UVC payloads and paces them.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <mutex>

#include "usbip.h"
#include "video_modes.h"

namespace hil {

/// Faults that a test asks for; they outlive an unplug.
struct StreamFaults {
  static constexpr uint64_t kUnlimited = std::numeric_limits<uint64_t>::max();
  uint64_t frames_allowed = kUnlimited;  // 0: frozen
  unsigned frames_to_shorten = 0;        // send half of each
  unsigned frames_to_mark = 0;           // set the payload header's error bit
};

class VideoStream {
 public:
  /// Answers go to `link`, which must outlive this. `faults` are those from before an unplug.
  VideoStream(UsbipLink& link, StreamFaults faults) : link_(link), faults_(faults) {}

  /// Begins at the first frame of `size`, which must outlive the stream.
  void start(const FrameSize& size, std::chrono::nanoseconds interval);
  void stop();

  /// The connection is gone: `run` returns.
  void close();

  /// A URB of the video endpoint waits to be filled.
  void submit(Submit submit);
  /// Takes a waiting URB back, if it still waits, and answers the kernel.
  void unlink(const Unlink& unlink);
  /// Answers a control transfer, between those of the video endpoint.
  void answer_control(const Submit& submit, int status, std::span<const uint8_t> data);

  void change_faults(const std::function<void(StreamFaults&)>& change);
  StreamFaults faults() const;

  /// Sends frames, as long as `close` has not been called.
  void run();

 private:
  using Clock = std::chrono::steady_clock;
  struct Picture {
    std::span<const uint8_t> bytes;
    size_t index;     // in the file
    unsigned parity;  // UVC's frame id bit
    bool marked;      // with the error bit
    uint64_t stream;  // the start() it belongs to
  };

  std::optional<Picture> wait_for_next();
  bool send(const Picture& picture);
  bool current(const Picture& picture) const { return !closed_ && stream_ == picture.stream; }

  UsbipLink& link_;

  // One lock for everything, held while a URB is taken and answered: were the two apart, the answer
  // to an unlink could overtake the answer to its victim, and vhci_hcd drops a device that does so.
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  StreamFaults faults_;
  bool closed_ = false;
  const FrameSize* size_ = nullptr;  // null: not streaming
  std::chrono::nanoseconds interval_{};
  Clock::time_point due_;
  uint64_t stream_ = 0;
  uint64_t frame_count_ = 0;  // of this stream
  std::deque<Submit> waiting_;
};

}  // namespace hil
