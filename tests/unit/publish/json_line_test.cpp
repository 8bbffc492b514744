#include "publish/json_line.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "publish/decoder.h"
#include "publish/encoder.h"
#include "sample_lists.h"

namespace bole {
namespace {

tree_list_t wire_list(const TreeList& list) {
  return decode_tree_list(TreeListEncoder().encode(list));
}

TEST(JsonLine, HasTheFieldNamesOfTheTypeInItsOrder) {
  const std::vector<Tree> trees = sample_trees(1);
  std::string line;
  write_json_line(wire_list(sample_list(trees)), "", line);
  EXPECT_EQ(line,
            "{\"utime\":1700000000123456,\"capture_mono_ns\":1234567890123,"
            "\"publish_mono_ns\":1234570000000,\"seq\":41,\"sensor_seq\":43,"
            "\"config_crc\":-559038737,\"source\":0,\"flags\":0,\"camera\":\"front\","
            "\"num_trees\":1,\"trees\":[{\"id\":0,\"bearing\":-3,\"range\":1,\"diameter\":0.25,"
            "\"score\":1,\"bearing_sigma\":0.015625,\"range_sigma\":0.125,"
            "\"diameter_sigma\":0.0625,\"base_elevation\":-0.5,\"angular_width\":0.25}]}\n");
}

TEST(JsonLine, FloatsReadBackAsTheSameFloats) {
  std::vector<Tree> trees;
  std::string line;
  const tree_list_t list = wire_list(extreme_list(trees));
  write_json_line(list, "", line);
  const auto tree = nlohmann::json::parse(line).at("trees").at(0);
  EXPECT_EQ(tree.at("bearing").get<float>(), list.trees[0].bearing);
  EXPECT_EQ(tree.at("diameter").get<float>(), list.trees[0].diameter);
  EXPECT_EQ(tree.at("score").get<float>(), list.trees[0].score);
}

TEST(JsonLine, AnyFileNameMakesValidJson) {
  std::string line;
  write_json_line(wire_list(sample_list({})), "a\"b\\\n\xff.png", line);
  EXPECT_EQ(std::ranges::count(line, '\n'), 1);
  EXPECT_THAT(nlohmann::json::parse(line).at("file").get<std::string>(),
              testing::StartsWith("a\"b\\\n"));
}

TEST(JsonLine, AStatusIsValidJson) {
  std::vector<std::byte> bytes;
  encode_status(sample_status(), bytes);
  std::string line;
  write_json_line(decode_status(bytes), line);
  const auto status = nlohmann::json::parse(line);
  EXPECT_EQ(status.at("buses").at(0).at("handover_histogram").size(), 20U);
  EXPECT_EQ(status.at("drops").at(0).at("name"), "overwritten");
  EXPECT_EQ(status.at("camera_events").at(0).at("count"), 3);
  EXPECT_EQ(status.at("degraded"), true);
}

}  // namespace
}  // namespace bole
