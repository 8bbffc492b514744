#include "video_function.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "events.h"
#include "uvc_requests.h"

namespace hil {
namespace {

// Standard requests (USB 2.0 table 9-4).
constexpr unsigned kGetStatus = 0;
constexpr unsigned kClearFeature = 1;
constexpr unsigned kSetFeature = 3;
constexpr unsigned kSetAddress = 5;
constexpr unsigned kGetDescriptor = 6;
constexpr unsigned kGetConfiguration = 8;
constexpr unsigned kSetConfiguration = 9;
constexpr unsigned kGetInterface = 10;
constexpr unsigned kSetInterface = 11;

constexpr unsigned kRecipientEndpoint = 2;

constexpr unsigned kNegotiationSize = 34;  // of the probe and commit controls in UVC 1.1

}  // namespace

struct VideoFunction::Setup {
  explicit Setup(const std::array<uint8_t, 8>& packet)
      : type(packet[0] >> 5 & 3u),
        recipient(packet[0] & 31u),
        request(packet[1]),
        value(read_little_endian(std::span(packet).subspan(2), 2)),
        index(read_little_endian(std::span(packet).subspan(4), 2)) {}
  bool is_standard() const { return type == 0; }
  bool is_class() const { return type == 1; }
  unsigned selector() const { return value >> 8; }
  unsigned interface() const { return index & 0xff; }
  unsigned entity() const { return index >> 8; }

  unsigned type;
  unsigned recipient;
  unsigned request;
  unsigned value;
  unsigned index;
};

VideoFunction::VideoFunction(Identity identity, std::vector<VideoFormat> formats,
                             std::vector<unsigned> rates)
    : identity_(std::move(identity)), formats_(std::move(formats)), rates_(std::move(rates)) {
  probe_ = commit_ = negotiate({});
}

std::optional<Bytes> VideoFunction::control_transfer(const std::array<uint8_t, 8>& packet,
                                                     std::span<const uint8_t> data,
                                                     VideoStream& stream) {
  const Setup setup(packet);
  if (setup.is_standard()) return standard_request(setup, stream);
  if (!setup.is_class()) return std::nullopt;
  if (setup.interface() == kStreamingInterface) return streaming_request(setup, data, stream);
  return entity_request(setup, data);
}

bool VideoFunction::ignores(const std::array<uint8_t, 8>& packet) const {
  const Setup setup(packet);
  return mute_ && setup.is_class() && setup.interface() != kStreamingInterface;
}

bool VideoFunction::refuse_control(std::string_view name, bool refused) {
  const std::lock_guard lock(controls_mutex_);
  Control* control = controls_.find(name);
  if (control == nullptr) return false;
  control->refused = refused;
  return true;
}

std::optional<Bytes> VideoFunction::standard_request(const Setup& setup,
                                                     VideoStream& stream) const {
  constexpr unsigned kDevice = 1, kConfiguration = 2, kString = 3, kStringCount = 4;
  switch (setup.request) {
    case kGetDescriptor:
      switch (setup.value >> 8) {
        case kDevice:
          return device_descriptor();
        case kConfiguration:
          return configuration_descriptor(formats_, rates_);
        case kString:
          if ((setup.value & 0xff) < kStringCount) {
            return string_descriptor(setup.value & 0xff, identity_);
          }
      }
      return std::nullopt;
    case kGetStatus:
      return Bytes{0, 0};
    case kGetConfiguration:
      return Bytes{1};
    case kGetInterface:
      return Bytes{0};
    case kClearFeature:  // uvcvideo ends a bulk stream by clearing the halt of its endpoint
      if (setup.recipient == kRecipientEndpoint) stream.stop();
      return Bytes{};
    case kSetConfiguration:
    case kSetInterface:
      stream.stop();
      return Bytes{};
    case kSetAddress:
    case kSetFeature:
      return Bytes{};
    default:
      return std::nullopt;
  }
}

std::optional<Bytes> VideoFunction::streaming_request(const Setup& setup,
                                                      std::span<const uint8_t> data,
                                                      VideoStream& stream) {
  const bool is_commit = setup.selector() == uvc::kCommitControl;
  if (!is_commit && setup.selector() != uvc::kProbeControl) return std::nullopt;
  Negotiation& state = is_commit ? commit_ : probe_;
  switch (setup.request) {
    case uvc::kSetCur:
      state = negotiate(data);
      if (is_commit) {
        const FrameSize& size = frame_size(state);
        const auto fourcc = formats_[state.format_index - 1].pixel_format->fourcc;
        Event("streaming")
            .add("format", fourcc)
            .add("width", size.width)
            .add("height", size.height)
            .add("interval_100ns", state.interval_100ns);
        stream.start(size, std::chrono::nanoseconds(100ll * state.interval_100ns));
      }
      return Bytes{};
    case uvc::kGetLen:
      return ByteWriter().u16(kNegotiationSize).take();
    case uvc::kGetInfo:
      return ByteWriter().u8({uvc::kCanGetAndSet}).take();
    case uvc::kGetCur:
    case uvc::kGetMin:
    case uvc::kGetMax:
    case uvc::kGetDef:
      return encode(state);
    default:
      return std::nullopt;
  }
}

std::optional<Bytes> VideoFunction::entity_request(const Setup& setup,
                                                   std::span<const uint8_t> data) {
  if (setup.entity() == 0) {
    // After a STALL the driver asks why; only refused controls stall in practice.
    if (setup.selector() != uvc::kRequestErrorCodeControl) return std::nullopt;
    return ByteWriter().u8({uvc::kErrorInvalidRequest}).take();
  }
  std::this_thread::sleep_for(delay_.load());
  const std::lock_guard lock(controls_mutex_);
  Control* control = controls_.find(setup.entity(), setup.selector());
  if (control == nullptr) return std::nullopt;
  if (setup.request == uvc::kSetCur) return set_control(*control, data);
  return read_control(*control, setup.request);
}

std::optional<Bytes> VideoFunction::set_control(Control& control, std::span<const uint8_t> data) {
  const auto value = static_cast<int32_t>(read_little_endian(data, control.size_bytes));
  Event(control.refused ? "control_refused" : "control")
      .add("name", control.name)
      .add("value", value);
  if (control.refused) return std::nullopt;
  control.current = value;
  return Bytes{};
}

// What the camera makes of the driver's wish: the nearest thing it has.
VideoFunction::Negotiation VideoFunction::negotiate(std::span<const uint8_t> wish) const {
  const auto at = [&](size_t offset, int size) {
    return read_little_endian(wish.subspan(std::min(offset, wish.size())), size);
  };
  Negotiation result;
  result.format_index = std::clamp<unsigned>(at(2, 1), 1, unsigned(formats_.size()));
  const auto& sizes = formats_[result.format_index - 1].sizes;
  result.frame_index = std::clamp<unsigned>(at(3, 1), 1, unsigned(sizes.size()));
  const uint32_t interval = at(4, 4);
  const bool offered = std::ranges::any_of(
      rates_, [&](unsigned rate) { return frame_interval_100ns(rate) == interval; });
  result.interval_100ns = offered ? interval : frame_interval_100ns(rates_.front());
  return result;
}

Bytes VideoFunction::encode(const Negotiation& negotiation) const {
  ByteWriter out;
  out.u16(0).u8({negotiation.format_index, negotiation.frame_index});
  out.u32(negotiation.interval_100ns).u16(0).u16(0).u16(0).u16(0).u16(0);
  out.u32(frame_size(negotiation).max_bytes).u32(kMaxPayloadBytes).u32(48'000'000);
  out.u8({3, 0, 0, 0});  // payload headers carry the frame id and the end of frame
  return out.take();
}

const FrameSize& VideoFunction::frame_size(const Negotiation& negotiation) const {
  return formats_[negotiation.format_index - 1].sizes[negotiation.frame_index - 1];
}

}  // namespace hil
