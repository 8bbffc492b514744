#include "evaluate/truth.h"

#include <gmock/gmock.h>

namespace bole {
namespace {

TEST(Truth, TakesFramesWithoutTimeForNoDrive) {
  const Truth truth = parse_truth(R"({"frames": [
      {"file": "a", "trees": []}, {"file": "b", "trees": []},
      {"file": "c", "utime": 0, "trees": []}, {"file": "d", "utime": 0, "trees": []},
      {"file": "e", "world": 3, "trees": []}]})",
                                  "truth.json");
  std::vector<int> worlds;
  for (const TruthFrame& frame : truth.frames) worlds.push_back(frame.world);
  EXPECT_THAT(worlds, testing::ElementsAre(-1, -2, 0, 0, 3));
}

}  // namespace
}  // namespace bole
