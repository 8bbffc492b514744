#include "capture/device_memory.h"

#include <sys/mman.h>

#include <cerrno>

#include "base/errors.h"
#include "capture/frame_source.h"

namespace bole {

DeviceMemory::DeviceMemory(int fd, off_t offset, std::size_t length, int protection) {
  void* address = ::mmap(nullptr, length, protection, MAP_SHARED, fd, offset);
  if (address == MAP_FAILED) {
    throw CaptureError("its buffers cannot be mapped: " + error_text(errno));
  }
  bytes_ = {static_cast<std::byte*>(address), length};
}

DeviceMemory::~DeviceMemory() {
  if (!bytes_.empty()) ::munmap(bytes_.data(), bytes_.size());
}

}  // namespace bole
