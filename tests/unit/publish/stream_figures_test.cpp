#include "publish/stream_figures.h"

#include <limits>

#include <gmock/gmock.h>

namespace bole {
namespace {

tree_list_t list_with_seq(std::int64_t seq) {
  tree_list_t list{};
  list.seq = seq;
  list.capture_mono_ns = seq * 100'000'000;
  list.publish_mono_ns = list.capture_mono_ns + 2'000'000;
  return list;
}

TEST(StreamFigures, GapsInSeqAreLosses) {
  StreamFigures figures;
  for (const int seq : {5, 6, 9, 10}) figures.add(list_with_seq(seq), seq * 100'000'000LL);
  EXPECT_EQ(figures.lists(), 4);
  EXPECT_EQ(figures.lost(), 2);
}

TEST(StreamFigures, ARestartedDaemonIsNoLoss) {
  StreamFigures figures;
  for (const int seq : {5, 6, 0, 1}) figures.add(list_with_seq(seq), 0);
  EXPECT_EQ(figures.lost(), 0);
  EXPECT_THAT(figures.text(), testing::HasSubstr(" 1 restarts"));
}

TEST(StreamFigures, NumbersThatNobodyCountsToDoNoHarm) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  StreamFigures figures;
  for (const std::int64_t seq : {std::int64_t{0}, kMost, std::int64_t{0}, kMost, -kMost - 1}) {
    tree_list_t list{};
    list.seq = seq;
    list.publish_mono_ns = -kMost - 1;
    list.capture_mono_ns = kMost;
    figures.add(list, kMost);
  }
  EXPECT_EQ(figures.lists(), 5);
}

TEST(StreamFigures, RateAndLatencyAreThoseOfTheLists) {
  StreamFigures figures;
  for (int seq = 0; seq < 11; ++seq) {
    figures.add(list_with_seq(seq), list_with_seq(seq).publish_mono_ns + 50'000);
  }
  EXPECT_THAT(figures.text(), testing::HasSubstr("11 lists, 10.0/s"));
  EXPECT_THAT(figures.text(), testing::HasSubstr("capture to publish p50 2.00"));
  EXPECT_THAT(figures.text(), testing::HasSubstr("publish to here p50 0.05"));
}

TEST(StreamFigures, JsonNamesTheStream) {
  EXPECT_THAT(StreamFigures().json("a\"b"), testing::StartsWith(R"({"stream":"a\"b","summary":{)"));
}

}  // namespace
}  // namespace bole
