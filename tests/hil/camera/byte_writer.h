// USB descriptors and UVC structures are packed little-endian bytes; this writes them in order.
#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

namespace hil {

using Bytes = std::vector<uint8_t>;

class ByteWriter {
 public:
  ByteWriter& u8(std::initializer_list<unsigned> values) {
    for (unsigned value : values) bytes_.push_back(static_cast<uint8_t>(value));
    return *this;
  }
  ByteWriter& u16(unsigned value) { return little_endian(value, 2); }
  ByteWriter& u32(uint32_t value) { return little_endian(value, 4); }
  ByteWriter& little_endian(uint32_t value, int size) {
    for (int i = 0; i < size; ++i) bytes_.push_back(static_cast<uint8_t>(value >> (8 * i)));
    return *this;
  }
  ByteWriter& append(std::span<const uint8_t> more) {
    bytes_.insert(bytes_.end(), more.begin(), more.end());
    return *this;
  }
  size_t size() const { return bytes_.size(); }
  Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

/// The little-endian number in `bytes`; those beyond its end count as zero.
inline uint32_t read_little_endian(std::span<const uint8_t> bytes, int size) {
  uint32_t value = 0;
  for (int i = 0; i < size && i < static_cast<int>(bytes.size()); ++i) {
    value |= static_cast<uint32_t>(bytes[i]) << (8 * i);
  }
  return value;
}

}  // namespace hil
