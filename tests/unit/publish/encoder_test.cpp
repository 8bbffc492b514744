#include "publish/encoder.h"

#include <cmath>
#include <random>

#include <gmock/gmock.h>

#include "golden_file.h"
#include "publish/decoder.h"
#include "sample_lists.h"

namespace bole {
namespace {

using testing::ElementsAreArray;

std::vector<std::byte> encoded(const TreeList& list) {
  TreeListEncoder encoder;
  const auto bytes = encoder.encode(list);
  return {bytes.begin(), bytes.end()};
}

TEST(Encoder, BytesOfAListWithoutTreesAreGolden) {
  const auto bytes = encoded(sample_list({}));
  EXPECT_THAT(bytes, ElementsAreArray(golden("publish/no_tree.bin", bytes)));
}

TEST(Encoder, BytesOfAListWithOneTreeAreGolden) {
  const std::vector<Tree> trees = sample_trees(1);
  const auto bytes = encoded(sample_list(trees));
  EXPECT_THAT(bytes, ElementsAreArray(golden("publish/one_tree.bin", bytes)));
}

TEST(Encoder, BytesOfTheMostTreesAreGolden) {
  const std::vector<Tree> trees = sample_trees(32);
  const auto bytes = encoded(sample_list(trees));
  EXPECT_THAT(bytes, ElementsAreArray(golden("publish/most_trees.bin", bytes)));
}

TEST(Encoder, BytesOfExtremeValuesAreGolden) {
  std::vector<Tree> trees;
  const auto bytes = encoded(extreme_list(trees));
  EXPECT_THAT(bytes, ElementsAreArray(golden("publish/extreme.bin", bytes)));
}

TEST(Encoder, BytesOfAStatusAreGolden) {
  std::vector<std::byte> bytes;
  encode_status(sample_status(), bytes);
  EXPECT_THAT(bytes, ElementsAreArray(golden("publish/status.bin", bytes)));
}

TEST(Encoder, TheLargestListFitsOneDatagram) {
  const std::vector<Tree> trees = sample_trees(100);
  TreeList list = sample_list(trees);
  list.camera = std::string(100, 'x');
  const std::size_t on_wire = encoded(list).size() + kLcmOverheadBytes;
  EXPECT_LE(on_wire, 1400U);
  EXPECT_GT(on_wire, 1300U);
}

TEST(Encoder, BeyondThirtyTwoTheNearestAreKeptAndTruncatedIsSet) {
  std::vector<Tree> trees = sample_trees(40);
  std::shuffle(trees.begin(), trees.end(), std::mt19937(1));
  const tree_list_t list = decode_tree_list(encoded(sample_list(trees)));
  ASSERT_EQ(list.num_trees, 32);
  EXPECT_EQ(list.flags, tree_list_t::FLAG_TRUNCATED);
  for (int k = 0; k < 32; ++k) EXPECT_EQ(list.trees[k].id, k);
}

TEST(Encoder, OrderOfTheTreesDoesNotChangeTheBytes) {
  std::vector<Tree> trees = sample_trees(20);
  for (Tree& tree : trees) tree.range = 2;
  const auto bytes = encoded(sample_list(trees));
  std::shuffle(trees.begin(), trees.end(), std::mt19937(2));
  EXPECT_EQ(encoded(sample_list(trees)), bytes);
}

TEST(Encoder, TreesThatAreNotFiniteAreLeftOutAndCounted) {
  std::vector<Tree> trees = sample_trees(4);
  trees[1].bearing = std::numeric_limits<float>::quiet_NaN();
  trees[2].range_sigma = std::numeric_limits<float>::infinity();
  TreeListEncoder encoder;
  const tree_list_t list = decode_tree_list(encoder.encode(sample_list(trees)));
  EXPECT_EQ(list.num_trees, 2);
  EXPECT_EQ(encoder.rejected(), 2);
}

TEST(Encoder, ALongCameraNameIsCutBetweenCharacters) {
  TreeList list = sample_list({});
  list.camera = std::string(15, 'a') + "\u00e9";  // the last character's two bytes are 15 and 16
  EXPECT_EQ(decode_tree_list(encoded(list)).camera, std::string(15, 'a'));
}

TEST(Encoder, SourcesAreThoseOfTheWire) {
  for (const auto& [source, wire] :
       {std::pair{ListSource::v4l2, tree_list_t::SOURCE_V4L2},
        std::pair{ListSource::libcamera, tree_list_t::SOURCE_LIBCAMERA},
        std::pair{ListSource::replay, tree_list_t::SOURCE_REPLAY},
        std::pair{ListSource::fake, tree_list_t::SOURCE_FAKE}}) {
    TreeList list = sample_list({});
    list.source = source;
    const tree_list_t decoded = decode_tree_list(encoded(list));
    EXPECT_EQ(decoded.source, wire);
    EXPECT_EQ(decoded.flags, source == ListSource::replay ? tree_list_t::FLAG_REPLAY : 0);
  }
}

TEST(Encoder, AStatusHasFiniteNumbersAndShortTexts) {
  status_t status = sample_status();
  status.latency_p99_ms = std::nanf("");
  status.buses[0].handover_max_us = std::numeric_limits<float>::infinity();
  status.last_error = std::string(1000, 'e');
  std::vector<std::byte> bytes;
  encode_status(status, bytes);
  const status_t decoded = decode_status(bytes);
  EXPECT_EQ(decoded.latency_p99_ms, 0);
  EXPECT_EQ(decoded.buses[0].handover_max_us, 0);
  EXPECT_EQ(decoded.last_error, std::string(kMostStatusTextBytes - 3, 'e') + "...");
}

}  // namespace
}  // namespace bole
