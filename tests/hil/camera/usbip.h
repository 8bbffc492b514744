// The part of USB/IP (Linux: Documentation/usb/usbip_protocol.rst) that a device on the local
// kernel's vhci_hcd needs: attaching a socket to a port of the virtual host controller, and the
// exchange of USB requests over it. No network is involved: the socket is one end of a socketpair.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <variant>

#include "base/files.h"
#include "byte_writer.h"

namespace hil {

/// The kernel submits one USB request: data to the device, or room for data from it.
struct Submit {
  uint32_t sequence;
  uint32_t endpoint;
  bool device_to_host;
  uint32_t length;               // bytes the host sends or has room for
  std::array<uint8_t, 8> setup;  // endpoint 0 only: the SETUP packet
  Bytes data;                    // host to device only
};

/// The kernel takes a request back that it has not seen answered.
struct Unlink {
  uint32_t sequence;
  uint32_t victim;  // the sequence number of the Submit to forget
};

using UsbipCommand = std::variant<Submit, Unlink>;

/// Our end of the socket. `receive` belongs to one thread; the senders lock among themselves
/// outside of this class.
class UsbipLink {
 public:
  explicit UsbipLink(bole::UniqueFd socket) : socket_(std::move(socket)) {}

  /// The next command, or nothing once the kernel or `shut_down` has ended the connection. An
  /// Unlink always comes after its victim: vhci_hcd's sender may send them the other way round when
  /// a driver takes a request back at once, and gives the device up if both are then answered.
  std::optional<UsbipCommand> receive();

  /// Answers a Submit. `status` is 0 or a negative errno (-EPIPE is a STALL); `data` goes to the
  /// host; `actual_length` is what was transferred in either direction.
  bool answer(const Submit& submit, int status, std::span<const uint8_t> data,
              uint32_t actual_length);

  /// Answers an Unlink: -ECONNRESET if the victim was still waiting, 0 if it was answered before.
  bool answer(const Unlink& unlink, int status);

  void shut_down();

 private:
  std::optional<UsbipCommand> receive_next();
  bool send_all(std::span<const uint8_t> bytes);
  bool receive_all(std::span<uint8_t> bytes);

  bole::UniqueFd socket_;
  uint32_t last_submit_ = 0;
  std::map<uint32_t, Unlink> early_;  // by victim: its Submit has not come yet
  std::optional<Unlink> held_back_;   // of the Submit that receive() gave last
};

/// One port of vhci_hcd.0 with a device in it.
class VhciAttachment {
 public:
  /// Plugs a high-speed device in and returns once the kernel has accepted it. Throws
  /// std::system_error if vhci_hcd is not loaded or the port is taken.
  explicit VhciAttachment(unsigned port);

  /// Pulls the device out and ends the connection, so that whoever waits in `receive` comes back.
  void detach();

  UsbipLink& link() { return link_; }

 private:
  unsigned port_;
  UsbipLink link_;
};

}  // namespace hil
