#include "publish/decoder.h"

#include <array>
#include <cstdint>
#include <cstdio>

namespace bole {
namespace {

// Goes over a message without keeping anything of it.
class Walker {
 public:
  explicit Walker(std::span<const std::byte> bytes) : rest_(bytes) {}

  void skip(std::size_t count) {
    if (count > rest_.size()) throw WireError("is cut off");
    rest_ = rest_.subspan(count);
  }

  std::int64_t big_endian(std::size_t count) {
    const std::span<const std::byte> field = rest_;
    skip(count);
    std::uint64_t value = 0;
    for (std::size_t k = 0; k < count; ++k) {
      value = value << 8 | std::to_integer<std::uint64_t>(field[k]);
    }
    return count == 4 ? static_cast<std::int32_t>(value) : static_cast<std::int64_t>(value);
  }

  // A text is its length with the closing zero, then the bytes and that zero.
  void skip_text() {
    const std::int64_t length = big_endian(4);
    if (length < 1) throw WireError("holds a text of impossible length");
    skip(static_cast<std::size_t>(length));
  }

  // The number of elements that follow, each of at least `least_bytes`.
  std::int64_t count(std::size_t least_bytes) {
    const std::int64_t elements = big_endian(4);
    if (elements < 0 || static_cast<std::uint64_t>(elements) > rest_.size() / least_bytes) {
      throw WireError("holds an impossible number of elements");
    }
    return elements;
  }

  void end() const {
    if (!rest_.empty()) throw WireError("has bytes left over");
  }

 private:
  std::span<const std::byte> rest_;
};

constexpr std::size_t kTreeBytes = 40;

void check_layout(Walker walker, const tree_list_t& /*type*/) {
  walker.skip(5 * 8 + 4 + 1 + 1);
  walker.skip_text();
  const std::int64_t trees = walker.count(kTreeBytes);
  walker.skip(static_cast<std::size_t>(trees) * kTreeBytes);
  walker.end();
}

void check_layout(Walker walker, const status_t& /*type*/) {
  walker.skip(8 + 8 + 8);
  for (int text = 0; text < 3; ++text) walker.skip_text();
  walker.skip(1);
  walker.skip_text();
  walker.skip(1);
  walker.skip_text();
  walker.skip(2 * 8 + 5 * 4);
  for (int list = 0; list < 2; ++list) {  // drops, camera_events
    for (std::int64_t counter = walker.count(4 + 1 + 8); counter > 0; --counter) {
      walker.skip_text();
      walker.skip(8);
    }
  }
  for (std::int64_t bus = walker.count(4 + 1 + 1 + 3 * 8); bus > 0; --bus) {
    walker.skip_text();
    walker.skip(1 + 3 * 8 + 3 * 4 + bus_t::HANDOVER_BINS * 4);
    walker.skip_text();
  }
  walker.skip_text();
  walker.end();
}

template <typename Message>
Message decode(std::span<const std::byte> bytes) {
  Walker walker(bytes);
  const std::int64_t fingerprint = walker.big_endian(8);
  if (fingerprint != Message::getHash()) {
    std::array<char, 80> text;
    std::snprintf(text.data(), text.size(), "is not a bole.%s of this version: fingerprint %016llx",
                  Message::getTypeName(), static_cast<unsigned long long>(fingerprint));
    throw WireError(text.data());
  }
  Message message;
  check_layout(walker, message);
  if (message.decode(bytes.data(), 0, static_cast<int>(bytes.size())) !=
      static_cast<int>(bytes.size())) {
    throw WireError("is damaged");
  }
  return message;
}

}  // namespace

tree_list_t decode_tree_list(std::span<const std::byte> bytes) {
  return decode<tree_list_t>(bytes);
}

status_t decode_status(std::span<const std::byte> bytes) { return decode<status_t>(bytes); }

}  // namespace bole
