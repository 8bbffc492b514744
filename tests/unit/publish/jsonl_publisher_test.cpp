#include "publish/jsonl_publisher.h"

#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "publish/encoder.h"
#include "sample_lists.h"
#include "support/config_problem.h"
#include "support/temporary_folder.h"

namespace bole {
namespace {

// No file grows beyond `bytes` as long as this lives: what stands in for a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  void (*handler_)(int);
  rlimit before_{};
};

std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(JsonlPublisher, GoesOnWithWhatAnEarlierOneWroteUnlessItIsToBeErased) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("lists.jsonl", "earlier\ntor");
  TreeListEncoder encoder;
  const auto bytes = encoder.encode(sample_list(sample_trees(1)));
  JsonlPublisher(file).publish(MessageKind::trees, bytes, "");
  const std::vector<std::string> lines = lines_of(file);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[1], "tor");
  JsonlPublisher(file).publish(MessageKind::trees, bytes, "");
  EXPECT_THAT(lines_of(file), testing::ElementsAre("earlier", "tor", lines[2], lines[2]));
  using Earlier = JsonlPublisher::Earlier;
  JsonlPublisher(file, Earlier::erased).publish(MessageKind::trees, bytes, "");
  EXPECT_THAT(lines_of(file), testing::ElementsAre(lines[2]));
}

TEST(JsonlPublisher, GoesOnAtTheEndOfAFileThatSomebodyHasCut) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "lists.jsonl";
  TreeListEncoder encoder;
  const auto bytes = encoder.encode(sample_list(sample_trees(1)));
  JsonlPublisher publisher(file);
  publisher.publish(MessageKind::trees, bytes, "");
  const std::uintmax_t size = std::filesystem::file_size(file);
  std::filesystem::resize_file(file, 0);
  publisher.publish(MessageKind::trees, bytes, "");
  EXPECT_EQ(std::filesystem::file_size(file), size) << "no zeros where the cut part was";
}

TEST(JsonlPublisher, BeginsANewLineAfterOneThatTheDiskTookInPart) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / "lists.jsonl";
  TreeListEncoder encoder;
  const std::vector<Tree> trees = sample_trees(1);
  const auto bytes = encoder.encode(sample_list(trees));
  JsonlPublisher publisher(file);
  const auto publish = [&] { publisher.publish(MessageKind::trees, bytes, "frame.jpg"); };
  publish();
  {
    const FullDisk disk(std::filesystem::file_size(file) + 20);
    EXPECT_THROW(publish(), BusError);
    EXPECT_THROW(publish(), BusError);  // nor is there room for a line feed
  }
  publish();
  publish();
  const std::vector<std::string> lines = lines_of(file);
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[1].size(), 20U);
  for (const std::size_t k : {2, 3}) EXPECT_EQ(lines[k], lines[0]);
}

TEST(JsonlPublisher, SaysWhyItCannotWriteAndWhichKeySaysSo) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(test::config_problem([&] {
                JsonlPublisher(folder.path(), JsonlPublisher::Earlier::kept, "boled.toml");
              }),
              testing::AllOf(testing::StartsWith("boled.toml: publish.to: jsonl:"),
                             testing::HasSubstr("Is a directory")));
}

}  // namespace
}  // namespace bole
