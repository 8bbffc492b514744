#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <new>
#include <span>

namespace bole {

/// Memory between two pages that must not be touched: a read or write one byte before its start or
/// behind its end is a fault. Only one of the two borders can lie on a page's: choose which.
class GuardedBuffer {
 public:
  enum class Tight { start, end };

  GuardedBuffer(std::size_t size, Tight tight) : page_(static_cast<std::size_t>(::getpagesize())) {
    const std::size_t inside = (size + page_ - 1) / page_ * page_;
    mapped_ = inside + 2 * page_;
    void* address = ::mmap(nullptr, mapped_, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (address == MAP_FAILED) throw std::bad_alloc();
    map_ = static_cast<std::byte*>(address);
    if (::mprotect(map_ + page_, inside, PROT_READ | PROT_WRITE) != 0) throw std::bad_alloc();
    const std::size_t start = tight == Tight::start ? 0 : inside - size;
    bytes_ = {map_ + page_ + start, size};
  }
  GuardedBuffer(const GuardedBuffer&) = delete;
  GuardedBuffer& operator=(const GuardedBuffer&) = delete;
  ~GuardedBuffer() { ::munmap(map_, mapped_); }

  std::span<std::byte> bytes() const { return bytes_; }

 private:
  std::size_t page_;
  std::size_t mapped_ = 0;
  std::byte* map_ = nullptr;
  std::span<std::byte> bytes_;
};

}  // namespace bole
