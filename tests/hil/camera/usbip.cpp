#include "usbip.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

namespace hil {
namespace {

constexpr uint32_t kCommandSubmit = 1;
constexpr uint32_t kCommandUnlink = 2;
constexpr uint32_t kReturnSubmit = 3;
constexpr uint32_t kReturnUnlink = 4;
constexpr unsigned kSpeedHigh = 3;  // enum usb_device_speed

// usbip_header: every field but `setup` is big-endian. Both directions have this size; the fields
// after `endpoint` mean different things by command.
struct Header {
  uint32_t command;
  uint32_t sequence;
  uint32_t device_id;
  uint32_t direction;
  uint32_t endpoint;
  uint32_t status_or_flags;  // Submit: transfer flags; Unlink: the victim; answers: the status
  uint32_t length;           // Submit: buffer length; answers: actual length
  uint32_t start_frame;
  uint32_t packet_count;  // isochronous only; all ones otherwise
  uint32_t interval_or_errors;
  std::array<uint8_t, 8> setup;
};
static_assert(sizeof(Header) == 48);

std::span<uint8_t> bytes_of(Header& header) {
  return {reinterpret_cast<uint8_t*>(&header), sizeof header};
}

void write_attribute(const char* name, const std::string& value) {
  const std::string path = std::string("/sys/devices/platform/vhci_hcd.0/") + name;
  const bole::UniqueFd file(open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (!file || write(file.get(), value.data(), value.size()) < 0) {
    throw std::system_error(errno, std::generic_category(), path);
  }
}

// Hands the kernel one end of a socketpair as the device in `port`, returns the other. The kernel
// holds its own reference, so the descriptor of its end is closed here.
bole::UniqueFd attach(unsigned port) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    throw std::system_error(errno, std::generic_category(), "socketpair");
  }
  bole::UniqueFd ours(ends[0]);
  const bole::UniqueFd kernels(ends[1]);
  // Room for a whole frame's worth of payloads: fewer wake-ups, which is what emulation is slow at.
  const int buffer_size = 1 << 20;
  for (int end : ends) {
    setsockopt(end, SOL_SOCKET, SO_SNDBUF, &buffer_size, sizeof buffer_size);
    setsockopt(end, SOL_SOCKET, SO_RCVBUF, &buffer_size, sizeof buffer_size);
  }
  const unsigned device_id =
      0x10000 + port + 1;  // bus 1, device port + 1; only the kernel's log uses it
  write_attribute("attach", std::to_string(port) + " " + std::to_string(kernels.get()) + " " +
                                std::to_string(device_id) + " " + std::to_string(kSpeedHigh));
  return ours;
}

}  // namespace

std::optional<UsbipCommand> UsbipLink::receive() {
  if (held_back_) return *std::exchange(held_back_, std::nullopt);
  while (true) {
    auto command = receive_next();
    if (!command) return std::nullopt;
    if (const auto* submit = std::get_if<Submit>(&*command)) {
      last_submit_ = submit->sequence;
      if (const auto early = early_.extract(submit->sequence)) held_back_ = early.mapped();
      return command;
    }
    const Unlink& unlink = std::get<Unlink>(*command);
    if (unlink.victim <= last_submit_) return command;
    early_.emplace(unlink.victim, unlink);
  }
}

std::optional<UsbipCommand> UsbipLink::receive_next() {
  Header header;
  if (!receive_all(bytes_of(header))) return std::nullopt;
  const uint32_t sequence = ntohl(header.sequence);
  switch (ntohl(header.command)) {
    case kCommandUnlink:
      return Unlink{sequence, ntohl(header.status_or_flags)};
    case kCommandSubmit: {
      Submit submit{.sequence = sequence,
                    .endpoint = ntohl(header.endpoint),
                    .device_to_host = ntohl(header.direction) == 1,
                    .length = ntohl(header.length),
                    .setup = header.setup,
                    .data = {}};
      if (!submit.device_to_host) {
        submit.data.resize(submit.length);
        if (!receive_all(submit.data)) return std::nullopt;
      }
      return submit;
    }
    default:
      return std::nullopt;  // no such command: the stream is out of step, nothing can follow
  }
}

bool UsbipLink::answer(const Submit& submit, int status, std::span<const uint8_t> data,
                       uint32_t actual_length) {
  Header header{};
  header.command = htonl(kReturnSubmit);
  header.sequence = htonl(submit.sequence);
  header.status_or_flags = htonl(static_cast<uint32_t>(status));
  header.length = htonl(actual_length);
  header.packet_count = 0xffffffffu;
  return send_all(bytes_of(header)) && send_all(data);
}

bool UsbipLink::answer(const Unlink& unlink, int status) {
  Header header{};
  header.command = htonl(kReturnUnlink);
  header.sequence = htonl(unlink.sequence);
  header.status_or_flags = htonl(static_cast<uint32_t>(status));
  return send_all(bytes_of(header));
}

void UsbipLink::shut_down() { shutdown(socket_.get(), SHUT_RDWR); }

bool UsbipLink::send_all(std::span<const uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return false;
    bytes = bytes.subspan(static_cast<size_t>(sent));
  }
  return true;
}

bool UsbipLink::receive_all(std::span<uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t received = recv(socket_.get(), bytes.data(), bytes.size(), 0);
    if (received <= 0) return false;
    bytes = bytes.subspan(static_cast<size_t>(received));
  }
  return true;
}

VhciAttachment::VhciAttachment(unsigned port) : port_(port), link_(attach(port)) {}

void VhciAttachment::detach() {
  try {
    write_attribute("detach", std::to_string(port_));
  } catch (const std::system_error&) {
    // The kernel has dropped the device by itself (a protocol error, or vhci_hcd is unloaded).
  }
  link_.shut_down();
}

}  // namespace hil
