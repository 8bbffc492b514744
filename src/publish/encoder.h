#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "bole/status_t.hpp"
#include "bole/tree_list_t.hpp"
#include "publish/tree_list.h"

namespace bole {

/// What one datagram may hold so that no network on the way splits it.
constexpr std::size_t kDatagramBytes = 1400;
/// LCM's short header (magic and sequence number) and the channel's name with its closing zero.
constexpr std::size_t kLcmOverheadBytes = 8 + sizeof("BOLE_TREES");
constexpr std::size_t kMostListBytes = kDatagramBytes - kLcmOverheadBytes;
/// No text of a status is longer; what is longer is cut and ends in "...".
constexpr std::size_t kMostStatusTextBytes = 80;

/// The one encoder of tree lists: what it writes goes to every bus as it is. Trees are ordered
/// nearest first; beyond tree_list_t's 32 the nearest are kept and `truncated` is set. A tree with
/// a number that is not finite is left out and counted. Keeps its memory from list to list: not for
/// two threads at once.
class TreeListEncoder {
 public:
  TreeListEncoder();

  /// At most kMostListBytes, valid until the next call. A longer camera name is cut.
  std::span<const std::byte> encode(const TreeList& list);

  /// Trees left out since the start because a number in them was not finite.
  std::int64_t rejected() const { return rejected_; }

 private:
  void choose_trees(std::span<const Tree> trees);

  tree_list_t message_;
  std::vector<Tree> chosen_;
  std::array<std::byte, kMostListBytes> bytes_;
  std::int64_t rejected_ = 0;
};

/// The wire form of a status into `bytes`, which keeps its capacity. The counts (num_drops,
/// num_buses) are taken from the vectors; texts are cut and numbers made finite where needed.
void encode_status(status_t status, std::vector<std::byte>& bytes);

}  // namespace bole
