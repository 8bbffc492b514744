#include "capture/v4l2/device.h"

#include <fcntl.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <system_error>
#include <utility>

#include "base/errors.h"
#include "capture/frame_source.h"

namespace bole {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> listed(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    entries.push_back(entry->path());
  }
  std::ranges::sort(entries);
  return entries;
}

// 12 of "/dev/video12"; -1 of what is no such name.
int number_of(const fs::path& node) {
  constexpr std::string_view kPrefix = "video";
  const std::string name = node.filename().string();
  if (!name.starts_with(kPrefix)) return -1;
  int number = -1;
  const char* const end = name.data() + name.size();
  const auto [stop, error] = std::from_chars(name.data() + kPrefix.size(), end, number);
  return error == std::errc() && stop == end ? number : -1;
}

std::string first_line(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

// The first of a camera's nodes gives frames; others may give metadata.
bool is_first_node(const fs::path& node) {
  return first_line("/sys/class/video4linux" / node.filename() / "index") == "0";
}

}  // namespace

V4l2Device::V4l2Device(const fs::path& path, std::function<void()> before_asking)
    : fd_(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)),
      before_asking_(std::move(before_asking)) {
  if (fd_) return;
  const int error = errno;
  std::string hint;
  if (error == EACCES || error == EPERM) hint = "; the user must be in the group video";
  throw CaptureError("cannot be opened: " + error_text(error) + hint);
}

int V4l2Device::call(unsigned long request, void* argument) const noexcept {
  int result = -1;
  do {
    result = ::ioctl(fd_.get(), request, argument);
  } while (result < 0 && errno == EINTR);
  return result < 0 ? errno : 0;
}

int V4l2Device::ask(unsigned long request, void* argument) const {
  if (before_asking_) before_asking_();
  const int error = call(request, argument);
  if (error == ETIMEDOUT) throw CaptureError("does not answer");
  return error;
}

v4l2_capability V4l2Device::capability() const {
  v4l2_capability capability{};
  const int error = ask(VIDIOC_QUERYCAP, &capability);
  if (error != 0) throw CaptureError("is no Video4Linux device: " + error_text(error));
  return capability;
}

v4l2_buf_type V4l2Device::capture_type() const {
  const v4l2_capability whole = capability();
  const __u32 caps =
      (whole.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? whole.device_caps : whole.capabilities;
  if ((caps & V4L2_CAP_STREAMING) != 0) {
    if ((caps & V4L2_CAP_VIDEO_CAPTURE) != 0) return V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if ((caps & V4L2_CAP_VIDEO_CAPTURE_MPLANE) != 0) return V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE;
  }
  throw CaptureError("gives no stream of video frames");
}

fs::path find_v4l2_device(const std::string& name) {
  std::error_code error;
  if (name.starts_with('/')) {
    fs::path node = fs::canonical(name, error);
    if (!error) return node;
    if (error != std::errc::no_such_file_or_directory) {
      throw CaptureError("cannot be found: " + error.message());
    }
    throw CaptureError(kNotThere);
  }
  for (const char* folder : {"/dev/v4l/by-id", "/dev/v4l/by-path"}) {
    fs::path node = fs::canonical(fs::path(folder) / name, error);
    if (!name.empty() && !error) return node;
  }
  for (const fs::path& node : v4l2_nodes()) {
    if (!name.empty() && usb_serial(node) == name && is_first_node(node)) return node;
  }
  throw CaptureError(kNotThere);
}

std::vector<fs::path> v4l2_nodes() {
  std::vector<fs::path> nodes = listed("/dev");
  std::erase_if(nodes, [](const fs::path& node) { return number_of(node) < 0; });
  std::ranges::sort(nodes, {}, number_of);
  return nodes;
}

std::string usb_serial(const fs::path& node) {
  // Above the video interface stands the USB device, which knows its serial number.
  const fs::path interface = "/sys/class/video4linux" / node.filename() / "device";
  std::error_code error;
  const fs::path resolved = fs::canonical(interface, error);
  if (error) return "";
  const std::string own = first_line(resolved / "serial");
  return own.empty() ? first_line(resolved.parent_path() / "serial") : own;
}

std::vector<fs::path> stable_names(const fs::path& node) {
  std::vector<fs::path> names;
  for (const char* folder : {"/dev/v4l/by-id", "/dev/v4l/by-path"}) {
    for (const fs::path& link : listed(folder)) {
      std::error_code error;
      if (fs::canonical(link, error) == node && !error) names.push_back(link);
    }
  }
  return names;
}

}  // namespace bole
