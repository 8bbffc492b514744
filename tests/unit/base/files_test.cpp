#include "base/files.h"

#include <sys/stat.h>

#include <span>
#include <string>

#include <gmock/gmock.h>

#include "support/config_problem.h"
#include "support/temporary_folder.h"

namespace bole {
namespace {

namespace fs = std::filesystem;
using test::config_problem;
using test::TemporaryFolder;
using testing::HasSubstr;

std::string text_of(const fs::path& path) { return read_text_file(path, 100); }

void write(const fs::path& path, std::string_view text) {
  write_file_atomically(path, std::as_bytes(std::span(text)));
}

TEST(WriteFileAtomically, LeavesAPipeWhatItIs) {
  const TemporaryFolder folder;
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(config_problem([&] { write(pipe, "new"); }), HasSubstr("is not a regular file"));
  EXPECT_TRUE(fs::is_fifo(pipe));
  fs::create_symlink(pipe, folder / "link");
  EXPECT_THAT(config_problem([&] { write(folder / "link", "new"); }),
              HasSubstr("is not a regular file"));
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
}

TEST(WriteFileAtomically, ReplacesWhatALinkLeadsTo) {
  const TemporaryFolder folder;
  const fs::path file = folder.write("file", "old");
  fs::create_symlink("file", folder / "link");
  write(folder / "link", "new");
  EXPECT_EQ(text_of(file), "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
}

TEST(WriteFileAtomically, SaysWhyAFolderCannotBeMade) {
  EXPECT_THAT(config_problem([] { write("/proc/none/file", ""); }),
              HasSubstr("/proc/none: cannot be made"));
  const TemporaryFolder folder;
  EXPECT_THAT(config_problem([&] { write(folder.write("file", "") / "below", ""); }),
              HasSubstr("Not a directory"));
}

TEST(CheckReplaceable, TellsWhatCannotBeWrittenAndLeavesNothing) {
  const TemporaryFolder folder;
  EXPECT_NO_THROW(check_replaceable(folder / "new/file"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
  EXPECT_THAT(config_problem([] { check_replaceable("/proc/file"); }),
              HasSubstr("/proc/file: cannot be written"));
}

}  // namespace
}  // namespace bole
