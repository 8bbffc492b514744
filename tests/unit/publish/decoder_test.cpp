#include "publish/decoder.h"

#include <random>

#include <gmock/gmock.h>

#include "publish/encoder.h"
#include "sample_lists.h"

namespace bole {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

std::vector<std::byte> list_bytes() {
  const std::vector<Tree> trees = sample_trees(3);
  TreeListEncoder encoder;
  const auto bytes = encoder.encode(sample_list(trees));
  return {bytes.begin(), bytes.end()};
}

std::vector<std::byte> status_bytes() {
  std::vector<std::byte> bytes;
  encode_status(sample_status(), bytes);
  return bytes;
}

TEST(Decoder, ReadsBackWhatTheEncoderWrote) {
  const tree_list_t list = decode_tree_list(list_bytes());
  EXPECT_EQ(list.seq, 41);
  EXPECT_EQ(list.camera, "front");
  ASSERT_EQ(list.num_trees, 3);
  EXPECT_EQ(list.trees[2].range, 1.5F);
  const status_t status = decode_status(status_bytes());
  EXPECT_EQ(status.state, status_t::STATE_NO_CAMERA);
  EXPECT_EQ(status.buses.at(0).published, 147);
}

TEST(Decoder, NamesAForeignType) {
  EXPECT_THAT([] { decode_tree_list(status_bytes()); },
              ThrowsMessage<WireError>(HasSubstr("is not a bole.tree_list_t of this version")));
  EXPECT_THAT([] { decode_status(list_bytes()); },
              ThrowsMessage<WireError>(HasSubstr("is not a bole.status_t of this version")));
}

TEST(Decoder, RefusesEveryTruncation) {
  for (const auto& whole : {list_bytes(), status_bytes()}) {
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const std::span<const std::byte> part(whole.data(), size);
      EXPECT_THROW(decode_tree_list(part), WireError);
      EXPECT_THROW(decode_status(part), WireError);
    }
  }
}

TEST(Decoder, RefusesBytesLeftOver) {
  auto bytes = list_bytes();
  bytes.push_back(std::byte{0});
  EXPECT_THROW(decode_tree_list(bytes), WireError);
}

TEST(Decoder, RefusesImpossibleCountsBeforeMakingRoomForThem) {
  for (const auto& [offset, name] :
       {std::pair{54, "length of the camera's name"}, std::pair{64, "number of trees"}}) {
    for (const std::byte high : {std::byte{0x7F}, std::byte{0xFF}}) {
      auto bytes = list_bytes();
      bytes[static_cast<std::size_t>(offset)] = high;
      EXPECT_THROW(decode_tree_list(bytes), WireError) << name;
    }
  }
}

TEST(Decoder, SurvivesFlippedBytes) {
  std::mt19937 random(7);
  for (const auto& whole : {list_bytes(), status_bytes()}) {
    for (int round = 0; round < 20'000; ++round) {
      auto bytes = whole;
      for (int flips = 0; flips < 3; ++flips) {
        // The fingerprint is left: what comes behind it is what has to be survived.
        bytes[8 + random() % (bytes.size() - 8)] = static_cast<std::byte>(random());
      }
      try {
        if (whole.size() == list_bytes().size()) {
          decode_tree_list(bytes);
        } else {
          decode_status(bytes);
        }
      } catch (const WireError&) {
      }
    }
  }
}

}  // namespace
}  // namespace bole
