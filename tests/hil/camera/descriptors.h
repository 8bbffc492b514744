// What the camera tells the kernel about itself when it is plugged in: USB 2.0 chapter 9
// descriptors and the class-specific ones of USB Video Class 1.1.
#pragma once

#include <span>
#include <string>

#include "byte_writer.h"
#include "video_modes.h"

namespace hil {

struct Identity {
  std::string product = "Rig Camera";
  std::string serial = "0001";
};

// Entities of the video function, in the order the picture takes.
constexpr unsigned kCameraTerminal = 1;
constexpr unsigned kProcessingUnit = 2;
constexpr unsigned kOutputTerminal = 3;

constexpr unsigned kControlInterface = 0;
constexpr unsigned kStreamingInterface = 1;
constexpr unsigned kVideoEndpoint = 1;  // bulk, to the host

/// The largest payload of one bulk transfer: what uvcvideo puts into one URB (32 packets of 512).
constexpr uint32_t kMaxPayloadBytes = 16384;

/// UVC counts frame intervals in units of 100 ns.
constexpr uint32_t frame_interval_100ns(unsigned frames_per_second) {
  return 10'000'000u / frames_per_second;
}

Bytes device_descriptor();

/// `rates` in frames per second, the default first; each size of each format offers all of them.
Bytes configuration_descriptor(std::span<const VideoFormat> formats,
                               std::span<const unsigned> rates);

/// Index 0 lists the languages; 1 manufacturer, 2 product, 3 serial number.
Bytes string_descriptor(unsigned index, const Identity& identity);

}  // namespace hil
