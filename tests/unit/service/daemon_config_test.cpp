#include "service/daemon_config.h"

#include <gmock/gmock.h>

#include "base/errors.h"
#include "base/files.h"
#include "support/temporary_folder.h"

namespace bole {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

DaemonConfig with(const std::vector<std::string>& pairs) {
  std::vector<Setting> settings;
  for (const std::string& pair : pairs) settings.push_back(parse_setting(pair));
  return load_daemon_config(std::nullopt, settings);
}

TEST(DaemonConfig, WithoutAFileTheDefaultsHold) {
  const DaemonConfig config = with({});
  EXPECT_EQ(config.publish.min_score, 0.5);
  EXPECT_EQ(config.lcm.text(), kDefaultLcmUrl);
  EXPECT_EQ(config.detect.mode, DetectorMode::bole);
  ASSERT_EQ(config.publish.to.size(), 1U);
  EXPECT_EQ(config.publish.to[0].bus, PublishTarget::Bus::lcm);
}

TEST(DaemonConfig, TheFileThatShipsSaysTheDefaults) {
  const auto shipped = std::filesystem::path(BOLE_SOURCE_DIR) / "systemd/boled.toml";
  const DaemonConfig config = load_daemon_config(shipped, {});
  EXPECT_EQ(config_crc(config, 1), config_crc(with({}), 1));
  EXPECT_EQ(config.lcm.text(), with({}).lcm.text());
  EXPECT_EQ(config.source.pace, with({}).source.pace);
  EXPECT_EQ(config.camera.file, with({}).camera.file);
}

TEST(DaemonConfig, SettingsAreTomlAndABareWordIsAString) {
  const DaemonConfig config =
      with({"publish.min_score=0.25", "detect.mode=paper", "camera.name=\"front\"",
            "publish.to=[\"jsonl:-\", \"lcm\"]", "source.uri=replay:/a=b", "source.loop=true"});
  EXPECT_EQ(config.publish.min_score, 0.25);
  EXPECT_EQ(config.detect.mode, DetectorMode::paper);
  EXPECT_EQ(config.camera.name, "front");
  EXPECT_EQ(config.publish.to.size(), 2U);
  EXPECT_EQ(config.publish.to[0].path, "-");
  EXPECT_EQ(config.source.uri, "replay:/a=b");
  EXPECT_TRUE(config.source.loop);
}

TEST(DaemonConfig, TheLaterSettingWins) {
  EXPECT_EQ(with({"publish.min_score=0.1", "publish.min_score=0.2"}).publish.min_score, 0.2);
}

TEST(DaemonConfig, SettingsLieOverTheFile) {
  const auto path = std::filesystem::path(testing::TempDir()) / "boled.toml";
  const std::string text = "[publish]\nmin_score = 0.7\nrobot = \"elk\"\n";
  write_file_atomically(path, std::as_bytes(std::span(text)));
  const DaemonConfig config = load_daemon_config(path, {{"publish.min_score", "0.9"}});
  EXPECT_EQ(config.publish.min_score, 0.9);
  EXPECT_EQ(config.publish.robot, "elk");
}

TEST(DaemonConfig, PathsInTheFileAreRelativeToItsFolderAndOfSettingsToWhereWeStand) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("boled.toml", R"(
    camera = { file = "front/camera.toml", table = "../warp.table", cache_directory = "/cache" }
    source = { uri = "replay:drive", faults = "faults.toml" }
    publish.to = ["lcm", "jsonl:lists.jsonl", "jsonl:-", "jsonl:/absolute"]
    zenoh = { config_file = "z.json5", tls = { ca = "ca.pem", certificate = "c", private_key = "k" } }
    service.trace = "trace.json"
  )");
  const DaemonConfig config = load_daemon_config(file, {});
  EXPECT_EQ(config.camera.file, folder / "front/camera.toml");
  EXPECT_EQ(config.camera.name, "front");
  EXPECT_EQ(config.camera.table, folder.path().parent_path() / "warp.table");
  EXPECT_EQ(config.camera.cache_directory, "/cache");
  EXPECT_EQ(config.source.uri, "replay:" + (folder / "drive").string());
  EXPECT_EQ(config.source.faults, folder / "faults.toml");
  EXPECT_EQ(config.publish.to.at(1).path, folder / "lists.jsonl");
  EXPECT_EQ(config.publish.to.at(2).path, "-");
  EXPECT_EQ(config.publish.to.at(3).path, "/absolute");
  EXPECT_EQ(config.zenoh.config_file, folder / "z.json5");
  EXPECT_EQ(config.zenoh.tls.ca, folder / "ca.pem");
  EXPECT_EQ(config.zenoh.tls.certificate, folder / "c");
  EXPECT_EQ(config.zenoh.tls.private_key, folder / "k");
  EXPECT_EQ(config.service.trace, folder / "trace.json");

  const DaemonConfig laid_over =
      load_daemon_config(file, {{"camera.file", "camera.toml"}, {"source.uri", "replay:drive"}});
  EXPECT_EQ(laid_over.camera.file, "camera.toml");
  EXPECT_EQ(laid_over.source.uri, "replay:drive");
  EXPECT_EQ(laid_over.source.faults, folder / "faults.toml");
}

TEST(DaemonConfig, TheCameraIsNamedAfterItsFolder) {
  EXPECT_EQ(with({"camera.file=/etc/bole/left eye/camera.toml"}).camera.name, "left_eye");
  EXPECT_EQ(with({"camera.file=/etc/bole/rear/./camera.toml"}).camera.name, "rear");
  EXPECT_EQ(with({"camera.file=/etc/bole/rear/../front/camera.toml"}).camera.name, "front");
  EXPECT_EQ(with({"camera.file=./camera.toml"}).camera.name,
            with({"camera.file=c.toml"}).camera.name);
  EXPECT_EQ(with({"camera.file=/a/abcdefghijklmnopqrstuvwxyz/c.toml"}).camera.name.size(), 16U);
}

TEST(DaemonConfig, RefusesWhatIsNotAsItMustBeAndNamesIt) {
  for (const char* pair :
       {"publish.min_score=1.5", "publish.min_score=nan", "publish.min_scor=0.5",
        "detect.mode=best", "publish.to=lcm", "publish.to=[\"udp\"]", "publish.to=[\"jsonl:\"]",
        "publish.to=[\"lcm\", \"lcm\"]", "publish.to=[]", "zenoh.mode=broker", "camera.name=\"\"",
        "camera.name=abcdefghijklmnopq", "publish.robot=\"a/b\"", "source.loop=1",
        "source.rate_hz=0", "lcm.url=tcp", "service.realtime_priority=100", "camera.file=["}) {
    const std::string text = pair;
    const std::string key = text.substr(0, text.find('='));
    EXPECT_THAT([&] { with({text}); }, ThrowsMessage<ConfigError>(HasSubstr(key))) << text;
  }
  EXPECT_THAT([] { with({"detec.mode=bole"}); },
              ThrowsMessage<ConfigError>(HasSubstr("detec: is not a known key")));
  EXPECT_THAT([] { with({"publish.min_score.x=1"}); },
              ThrowsMessage<ConfigError>(HasSubstr("publish.min_score: is not a number")));
}

TEST(DaemonConfig, ASettingWithoutKeyOrValueSignIsRefused) {
  EXPECT_THROW(parse_setting("publish.min_score"), ConfigError);
  EXPECT_THROW(parse_setting("=1"), ConfigError);
  EXPECT_THROW(with({"publish..min_score=1"}), ConfigError);
}

TEST(DaemonConfig, RefusesKeysNestedTooDeep) {
  std::string deep = "a";
  for (int k = 0; k < 40'000; ++k) deep += ".a";
  EXPECT_THAT([&] { with({deep + "=1"}); }, ThrowsMessage<ConfigError>(HasSubstr("--set: line 1")));
  EXPECT_THAT([&] { with({"source.uri={" + deep + "=1}"}); },
              ThrowsMessage<ConfigError>(HasSubstr("dots")));
  const test::TemporaryFolder folder;
  const auto file = folder.write("boled.toml", "# " + std::string(999, '.') + "\n" + deep + " = 1");
  EXPECT_THAT([&] { load_daemon_config(file, {}); },
              ThrowsMessage<ConfigError>(HasSubstr("boled.toml: line 2: has more than 1000 dots")));
}

TEST(DaemonConfig, TheCrcTellsDaemonsApartThatMakeOtherLists) {
  const std::uint32_t crc = config_crc(with({}), 1);
  EXPECT_EQ(config_crc(with({"publish.to=[\"jsonl:-\"]"}), 1), crc);
  EXPECT_NE(config_crc(with({}), 2), crc);
  EXPECT_NE(config_crc(with({"detect.mode=paper"}), 1), crc);
  EXPECT_NE(config_crc(with({"publish.min_score=0.51"}), 1), crc);
}

}  // namespace
}  // namespace bole
