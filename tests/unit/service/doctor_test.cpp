#include "service/doctor.h"

#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include <gmock/gmock.h>

#include "support/temporary_folder.h"

namespace bole {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string detail_of(const std::vector<Finding>& findings, const std::string& check) {
  for (const Finding& finding : findings) {
    if (finding.check == check) return finding.detail;
  }
  return "no such check";
}

class Doctor : public testing::Test {
 protected:
  Doctor() {
    ::unsetenv("CACHE_DIRECTORY");
    folder_.write("frame.yuyv", std::string(640 * 480 * 2, '\0'));
  }
  ~Doctor() override { ::unsetenv("CACHE_DIRECTORY"); }

  std::vector<Finding> findings(const std::vector<Setting>& more = {}) const {
    const std::string targets = R"(["lcm", ")" + ("jsonl:" + (folder_ / "lists").string()) + "\"]";
    std::vector<Setting> settings = {
        {"camera.file", toml_text(BOLE_SOURCE_DIR "/tests/hil/cameras/640x480/camera.toml")},
        {"source.uri", toml_text("replay:" + folder_.path().string())},
        {"publish.to", targets}};
    settings.insert(settings.end(), more.begin(), more.end());
    return examine(load_daemon_config(std::nullopt, settings));
  }

  const test::TemporaryFolder folder_;
  const passwd* const user_ = ::getpwuid(::geteuid());
  const std::string as_us_ =
      "(as user " + (user_ != nullptr ? user_->pw_name : std::to_string(::geteuid()));
};

TEST_F(Doctor, SaysAsWhomItLookedAndWhatTheServiceWouldFind) {
  const auto found = findings();
  EXPECT_THAT(detail_of(found, "camera files"), HasSubstr(as_us_ + "; the service has a user"));
  EXPECT_THAT(detail_of(found, "warp table"),
              AllOf(HasSubstr(as_us_), HasSubstr("/var/cache/bole")));
  EXPECT_THAT(detail_of(found, "source"), HasSubstr(as_us_));
  EXPECT_THAT(detail_of(found, "jsonl"), AllOf(HasSubstr(as_us_), HasSubstr("/var/lib/bole")));
  EXPECT_THAT(detail_of(found, "lcm"), Not(HasSubstr("as user"))) << "a route is everybody's";
}

TEST_F(Doctor, SaysNothingOfTheServiceWithinIt) {
  ::setenv("CACHE_DIRECTORY", folder_.path().c_str(), 1);
  const auto found = findings();
  EXPECT_THAT(detail_of(found, "warp table"),
              AllOf(HasSubstr(folder_.path().string()), HasSubstr(as_us_ + ")")));
  EXPECT_THAT(detail_of(found, "jsonl"), HasSubstr(as_us_ + ")"));
}

TEST_F(Doctor, SaysWhatBoledRefusesTheTableFor) {
  const auto camera = folder_.write("camera.toml", R"(
[camera]
model = "pinhole"
horizontal_fov_deg = 60
width = 640
height = 480
[mount]
height_m = 1
pitch_deg = -89
)");
  const auto found = findings({{"camera.file", toml_text(camera.string())}});
  const auto table = std::ranges::find(found, "warp table", &Finding::check);
  ASSERT_NE(table, found.end());
  EXPECT_FALSE(table->good) << table->detail;
}

TEST_F(Doctor, SaysThatATraceCannotBeWritten) {
  const auto found = findings({{"service.trace", toml_text("/proc/trace")}});
  ASSERT_EQ(found.back().check, "trace");
  EXPECT_FALSE(found.back().good);
  EXPECT_THAT(found.back().detail, HasSubstr("/proc/trace: cannot be written"));
}

}  // namespace
}  // namespace bole
