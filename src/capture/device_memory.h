#pragma once

#include <sys/types.h>

#include <cstddef>
#include <span>
#include <utility>

namespace bole {

/// A device's memory in this process; unmapped when dropped.
class DeviceMemory {
 public:
  DeviceMemory() = default;
  /// Maps the `length` bytes of `fd` from `offset` on, shared with the device; `protection` as mmap
  /// takes it. Throws CaptureError.
  DeviceMemory(int fd, off_t offset, std::size_t length, int protection);
  DeviceMemory(DeviceMemory&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}
  DeviceMemory& operator=(DeviceMemory&& other) noexcept {
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  DeviceMemory(const DeviceMemory&) = delete;
  DeviceMemory& operator=(const DeviceMemory&) = delete;
  ~DeviceMemory();

  /// Empty where nothing was mapped.
  std::span<std::byte> bytes() const { return bytes_; }

 private:
  std::span<std::byte> bytes_;
};

}  // namespace bole
