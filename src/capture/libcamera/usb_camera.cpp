#include "capture/libcamera/usb_camera.h"

#include <fcntl.h>
#include <poll.h>

#include <filesystem>
#include <optional>
#include <system_error>

#include "capture/v4l2/device.h"

namespace bole {
namespace {

namespace fs = std::filesystem;

// "2.4:1.0" (ports, configuration and interface) of a name that ends in "-2.4:1.0-046d:082d", as
// libcamera's names of USB cameras do; empty of others.
std::string place_in(const std::string& id) {
  const std::size_t product = id.rfind('-');
  if (product == std::string::npos || product == 0) return "";
  const std::size_t before = id.rfind('-', product - 1);
  if (before == std::string::npos) return "";
  const std::string place = id.substr(before + 1, product - before - 1);
  return place.find(':') == std::string::npos ? "" : place;
}

// The same of a node whose USB interface is called 3-2.4:1.0; empty of a node that is not on USB.
std::string place_of(const fs::path& node) {
  std::error_code error;
  const fs::path device = "/sys/class/video4linux" / node.filename() / "device";
  const std::string interface = fs::canonical(device, error).filename().string();
  const std::size_t bus_end = interface.find('-');
  return error || bus_end == std::string::npos ? "" : interface.substr(bus_end + 1);
}

std::optional<fs::path> node_at(const std::string& place) {
  for (const fs::path& node : v4l2_nodes()) {
    if (!place.empty() && place_of(node) == place) return node;
  }
  return std::nullopt;
}

UniqueFd open_node(const std::string& id) {
  const std::optional<fs::path> node = node_at(place_in(id));
  return node ? UniqueFd(::open(node->c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) : UniqueFd();
}

}  // namespace

bool usb_camera_is_missing(const std::string& id) {
  const std::string place = place_in(id);
  return !place.empty() && !node_at(place);
}

UnplugWatch::UnplugWatch(const std::string& id) : node_(open_node(id)) {}

bool UnplugWatch::unplugged() const noexcept {
  pollfd event{node_.get(), POLLPRI, 0};
  return ::poll(&event, 1, 0) > 0 && (event.revents & POLLHUP) != 0;
}

}  // namespace bole
