#include "descriptors.h"

#include <utility>

namespace hil {
namespace {

// Descriptor types and subtypes (USB 2.0 table 9-5, UVC 1.1 appendix A).
constexpr unsigned kDevice = 0x01;
constexpr unsigned kConfiguration = 0x02;
constexpr unsigned kString = 0x03;
constexpr unsigned kInterface = 0x04;
constexpr unsigned kEndpoint = 0x05;
constexpr unsigned kInterfaceAssociation = 0x0b;
constexpr unsigned kClassSpecific = 0x24;

constexpr unsigned kVcHeader = 0x01;
constexpr unsigned kVcInputTerminal = 0x02;
constexpr unsigned kVcOutputTerminal = 0x03;
constexpr unsigned kVcProcessingUnit = 0x05;

constexpr unsigned kVsInputHeader = 0x01;
constexpr unsigned kVsFormatUncompressed = 0x04;
constexpr unsigned kVsFrameUncompressed = 0x05;
constexpr unsigned kVsFormatMjpeg = 0x06;
constexpr unsigned kVsFrameMjpeg = 0x07;
constexpr unsigned kVsColorFormat = 0x0d;

constexpr unsigned kVideoClass = 0x0e;
constexpr unsigned kVideoControl = 0x01;
constexpr unsigned kVideoStreaming = 0x02;
constexpr unsigned kVideoCollection = 0x03;

constexpr unsigned kUvcVersion = 0x0110;
constexpr unsigned kTerminalCamera = 0x0201;
constexpr unsigned kTerminalStreaming = 0x0101;
constexpr uint32_t kClockHz = 48'000'000;

Bytes entities() {
  ByteWriter out;
  // Camera terminal; bmControls: exposure mode (bit 1) and absolute exposure time (bit 3).
  out.u8({18, kClassSpecific, kVcInputTerminal, kCameraTerminal}).u16(kTerminalCamera);
  out.u8({0, 0}).u16(0).u16(0).u16(0).u8({3, 0b1010, 0, 0});
  // Processing unit; bmControls: brightness (0), white balance temperature (6), gain (9),
  // power-line frequency (10), automatic white balance (12).
  out.u8({12, kClassSpecific, kVcProcessingUnit, kProcessingUnit, kCameraTerminal}).u16(0);
  out.u8({2, 0b0100'0001, 0b0001'0110, 0, 0});
  // Output terminal: the stream to the host.
  out.u8({9, kClassSpecific, kVcOutputTerminal, kOutputTerminal}).u16(kTerminalStreaming);
  out.u8({0, kProcessingUnit, 0});
  return out.take();
}

Bytes control_interface() {
  const Bytes units = entities();
  constexpr unsigned kHeaderSize = 13;
  ByteWriter out;
  out.u8({9, kInterface, kControlInterface, 0, 0, kVideoClass, kVideoControl, 0, 2});
  out.u8({kHeaderSize, kClassSpecific, kVcHeader}).u16(kUvcVersion);
  out.u16(kHeaderSize + unsigned(units.size())).u32(kClockHz).u8({1, kStreamingInterface});
  out.append(units);
  return out.take();
}

void append_format(ByteWriter& out, const VideoFormat& format, unsigned index) {
  const unsigned size_count = unsigned(format.sizes.size());
  if (format.pixel_format->is_jpeg()) {
    out.u8({11, kClassSpecific, kVsFormatMjpeg, index, size_count, 1, 1, 0, 0, 0, 0});
  } else {
    out.u8({27, kClassSpecific, kVsFormatUncompressed, index, size_count});
    out.append(format.pixel_format->guid);
    out.u8({format.pixel_format->bits_per_pixel, 1, 0, 0, 0, 0});
  }
}

void append_frame(ByteWriter& out, const VideoFormat& format, const FrameSize& size, unsigned index,
                  std::span<const unsigned> rates) {
  const auto bit_rate = [&](unsigned rate) { return size.max_bytes * 8 * rate; };
  const auto [slowest, fastest] = std::ranges::minmax(rates);
  const unsigned subtype = format.pixel_format->is_jpeg() ? kVsFrameMjpeg : kVsFrameUncompressed;
  out.u8({26 + 4 * unsigned(rates.size()), kClassSpecific, subtype, index, 0});
  out.u16(size.width).u16(size.height).u32(bit_rate(slowest)).u32(bit_rate(fastest));
  out.u32(size.max_bytes).u32(frame_interval_100ns(rates.front())).u8({unsigned(rates.size())});
  for (unsigned rate : rates) out.u32(frame_interval_100ns(rate));
}

Bytes formats_and_frames(std::span<const VideoFormat> formats, std::span<const unsigned> rates) {
  ByteWriter out;
  unsigned format_index = 0;
  for (const VideoFormat& format : formats) {
    append_format(out, format, ++format_index);
    unsigned size_index = 0;
    for (const FrameSize& size : format.sizes) {
      append_frame(out, format, size, ++size_index, rates);
    }
    out.u8({6, kClassSpecific, kVsColorFormat, 1, 1, 4});  // sRGB, BT.709, SMPTE 170M
  }
  return out.take();
}

Bytes streaming_interface(std::span<const VideoFormat> formats, std::span<const unsigned> rates) {
  const Bytes body = formats_and_frames(formats, rates);
  const unsigned header_size = 13 + unsigned(formats.size());
  ByteWriter out;
  out.u8({9, kInterface, kStreamingInterface, 0, 1, kVideoClass, kVideoStreaming, 0, 0});
  out.u8({header_size, kClassSpecific, kVsInputHeader, unsigned(formats.size())});
  out.u16(header_size + unsigned(body.size()));
  out.u8({0x80 | kVideoEndpoint, 0, kOutputTerminal, 0, 0, 0, 1});
  for (size_t i = 0; i < formats.size(); ++i) out.u8({0});  // no controls of single formats
  out.append(body);
  out.u8({7, kEndpoint, 0x80 | kVideoEndpoint, 2}).u16(512).u8({0});  // bulk, high speed
  return out.take();
}

}  // namespace

Bytes device_descriptor() {
  ByteWriter out;
  out.u8({18, kDevice}).u16(0x0200);
  out.u8({0xef, 2, 1, 64});                 // class by interface association
  out.u16(0x1209).u16(0x0001).u16(0x0100);  // pid.codes' vendor, its product for tests
  out.u8({1, 2, 3, 1});                     // the three strings; one configuration
  return out.take();
}

Bytes configuration_descriptor(std::span<const VideoFormat> formats,
                               std::span<const unsigned> rates) {
  ByteWriter interfaces;
  interfaces.u8(
      {8, kInterfaceAssociation, kControlInterface, 2, kVideoClass, kVideoCollection, 0, 2});
  interfaces.append(control_interface());
  interfaces.append(streaming_interface(formats, rates));
  const Bytes body = interfaces.take();

  ByteWriter out;
  out.u8({9, kConfiguration}).u16(9 + unsigned(body.size()));
  out.u8({2, 1, 0, 0x80, 250});  // two interfaces, configuration 1, bus powered, 500 mA
  out.append(body);
  return out.take();
}

Bytes string_descriptor(unsigned index, const Identity& identity) {
  ByteWriter out;
  if (index == 0) return out.u8({4, kString}).u16(0x0409).take();  // English (United States)
  const std::string text = index == 1 ? "bole" : index == 2 ? identity.product : identity.serial;
  out.u8({2 + 2 * unsigned(text.size()), kString});
  for (char c : text) out.u16(static_cast<uint8_t>(c));
  return out.take();
}

}  // namespace hil
