#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>

#include "bole/status_t.hpp"
#include "bole/tree_list_t.hpp"

namespace bole {

/// A payload that is not what the channel or key promises; what() says what it is instead.
class WireError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A tree list from its wire form. The generated decoder trusts the lengths in a message; here they
/// are checked against the bytes that are there first, so that nothing that somebody else puts on
/// the bus can exhaust the memory. Throws WireError for a foreign or newer type and for damage.
tree_list_t decode_tree_list(std::span<const std::byte> bytes);

/// As decode_tree_list, for a status.
status_t decode_status(std::span<const std::byte> bytes);

}  // namespace bole
