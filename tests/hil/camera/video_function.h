// The camera's side of endpoint 0: standard USB requests and those of the video class.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "byte_writer.h"
#include "controls.h"
#include "descriptors.h"
#include "video_modes.h"
#include "video_stream.h"

namespace hil {

class VideoFunction {
 public:
  VideoFunction(Identity identity, std::vector<VideoFormat> formats, std::vector<unsigned> rates);

  /// Answers one control transfer: the bytes for the host (empty for a host-to-device request), or
  /// nothing for a STALL. Committing a stream starts it; halting its endpoint stops it.
  std::optional<Bytes> control_transfer(const std::array<uint8_t, 8>& setup,
                                        std::span<const uint8_t> data, VideoStream& stream);

  /// From now on the control of this name refuses to be set, or no longer does. False if there is
  /// no such control.
  bool refuse_control(std::string_view name, bool refused);

  /// From now on each request of a control is answered so much later.
  void hesitate(std::chrono::milliseconds delay) { delay_ = delay; }
  /// From now on requests of controls get no answer at all, or do.
  void mute(bool mute) { mute_ = mute; }
  /// Whether this request gets no answer.
  bool ignores(const std::array<uint8_t, 8>& setup) const;

 private:
  struct Setup;
  // The video probe and commit controls' fields that matter here (UVC 1.1 table 4-75).
  struct Negotiation {
    unsigned format_index = 1;
    unsigned frame_index = 1;
    uint32_t interval_100ns = 0;
  };

  std::optional<Bytes> standard_request(const Setup& setup, VideoStream& stream) const;
  std::optional<Bytes> streaming_request(const Setup& setup, std::span<const uint8_t> data,
                                         VideoStream& stream);
  std::optional<Bytes> entity_request(const Setup& setup, std::span<const uint8_t> data);
  std::optional<Bytes> set_control(Control& control, std::span<const uint8_t> data);
  Negotiation negotiate(std::span<const uint8_t> wish) const;
  Bytes encode(const Negotiation& negotiation) const;
  const FrameSize& frame_size(const Negotiation& negotiation) const;

  const Identity identity_;
  const std::vector<VideoFormat> formats_;
  const std::vector<unsigned> rates_;
  Negotiation probe_;
  Negotiation commit_;
  std::atomic<std::chrono::milliseconds> delay_{std::chrono::milliseconds(0)};
  std::atomic<bool> mute_ = false;
  std::mutex controls_mutex_;  // commands come on another thread than requests
  Controls controls_;
};

}  // namespace hil
