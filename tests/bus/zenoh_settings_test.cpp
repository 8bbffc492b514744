#include "zenoh_sessions.h"

#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "support/config_problem.h"

namespace bole {
namespace {

using namespace std::chrono_literals;
using namespace test;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;

TEST(ZenohSession, RefusesMalformedEndpoints) {
  for (const auto& [endpoint, why] : std::vector<std::pair<std::string, std::string>>{
           {"127.0.0.1:7447", "is no endpoint"},
           {"tcp/", "is no endpoint"},
           {"udp/127.0.0.1:7447", "has a protocol that is not built in"},
           {"tcp/127.0.0.1", "has no host and port"},
           {"tcp/127.0.0.1:77777", "has no host and port"},
           {"tcp/:7447", "has no host and port"},
       }) {
    const auto expected = AllOf(HasSubstr("boled.toml: zenoh.connect: "), HasSubstr(endpoint),
                                HasSubstr(why), HasSubstr("tcp/HOST:PORT"));
    EXPECT_THAT(config_problem([&] { ZenohSession session(connecting(endpoint)); }), expected);
  }
  EXPECT_THAT(config_problem([] { ZenohSession session(listening("tcp/x")); }),
              HasSubstr("zenoh.listen"));
}

TEST(ZenohSession, WaitsForAPortInUseAndSaysSo) {
  int port = 0;
  auto taken = bind_to_free_port(port);
  ASSERT_EQ(listen(taken.get(), 1), 0);
  const auto endpoint = "tcp/127.0.0.1:" + std::to_string(port);
  const ZenohSession session(listening(endpoint));
  EXPECT_TRUE(eventually([&] { return !session.state().error.empty(); }));
  EXPECT_FALSE(session.state().open);
  EXPECT_THAT(session.state().error,
              AllOf(HasSubstr(endpoint + ": the port is in use"), HasSubstr("zenoh.listen")));
  taken.reset();
  EXPECT_TRUE(eventually([&] { return session.state().open; }));
  EXPECT_EQ(session.state().error, "");
}

TEST(ZenohSession, TellsFirstWhyItCannotListenAtAnAddressThatIsNotOurs) {
  const ZenohSession session(listening("tcp/192.0.2.77:17559"));  // TEST-NET-1
  EXPECT_TRUE(eventually([&] { return !session.state().error.empty(); }));
  EXPECT_THAT(session.state().error,
              AllOf(StartsWith("Cannot assign requested address"), HasSubstr("192.0.2.77:17559")));
}

TEST(ZenohSettings, AreCheckedWithoutAPort) {
  int port = 0;
  const auto taken = bind_to_free_port(port);
  ASSERT_EQ(listen(taken.get(), 1), 0);
  EXPECT_NO_THROW(check_zenoh(listening("tcp/127.0.0.1:" + std::to_string(port))));
  EXPECT_THAT(config_problem([] { check_zenoh(connecting("tcp/127.0.0.1")); }),
              HasSubstr("boled.toml: zenoh.connect: "));
}

TEST(ZenohSession, RefusesSettingsThatCannotWork) {
  auto config = listening(free_endpoint());
  config.mode = "broker";
  EXPECT_THAT(config_problem([&] { ZenohSession session(config); }), HasSubstr("zenoh.mode"));
  config = {};
  config.mode = "client";
  EXPECT_THAT(config_problem([&] { ZenohSession session(config); }), HasSubstr("zenoh.connect"));
  config = listening(free_endpoint());
  config.config_file = "/nonexistent.json5";
  EXPECT_THAT(config_problem([&] { ZenohSession session(config); }),
              AllOf(HasSubstr("zenoh.config_file"), HasSubstr("/nonexistent.json5")));
  const auto endpoint = free_endpoint();
  for (const std::string name : {"a*", "a/", ""}) {
    EXPECT_NE(config_problem([&] {
                ZenohSession session(listening(endpoint), {{name, "top"}});
              }),
              "none")
        << name;
  }
}

class ZenohFiles : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::TempDir() + "zenohXXXXXX";
    folder_ = mkdtemp(name.data());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return folder_ / name; }

  // A certificate for 127.0.0.1, NAME.pem and NAME.key, signed by SIGNER (or by itself).
  void make_certificate(const std::string& name, const std::string& signer = "") {
    std::string command = "cd " + folder_.string() +
                          " && openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256"
                          " -nodes -days 2 -subj /CN=" +
                          name + " -keyout " + name + ".key -out " + name + ".pem";
    if (!signer.empty()) {
      command += " -CA " + signer + ".pem -CAkey " + signer + ".key" +
                 " -addext subjectAltName=IP:127.0.0.1 -addext basicConstraints=CA:FALSE";
    }
    ASSERT_EQ(std::system((command + " 2>" + path("openssl.log")).c_str()), 0);
  }

  ZenohConfig::Tls tls(const std::string& name, bool mutual) const {
    return {.ca = path("ca.pem"),
            .certificate = path(name + ".pem"),
            .private_key = path(name + ".key"),
            .mutual = mutual};
  }

 private:
  std::filesystem::path folder_;
};

TEST_F(ZenohFiles, MutualTlsLetsInWhoHasACertificateAndNoOtherAndSaysSo) {
  make_certificate("ca");
  make_certificate("daemon", "ca");
  make_certificate("planner", "ca");
  const auto endpoint = free_endpoint("tls");
  auto server = listening(endpoint);
  server.tls = tls("daemon", true);
  ZenohSession daemon(server, identity);
  ASSERT_TRUE(eventually([&] { return daemon.state().open; }));

  ZenohSession::take_warnings();
  auto stranger = connecting(endpoint);
  stranger.tls.ca = path("ca.pem");
  std::string refusal;
  {
    ZenohSession refused(stranger, std::nullopt, {"bole/**"});
    EXPECT_TRUE(eventually([&] {
      for (const auto& warning : ZenohSession::take_warnings()) refusal += warning.text + "\n";
      return refusal.find("peer sent no certificates") != std::string::npos;
    })) << refusal;
    EXPECT_FALSE(refused.state().connected());
  }
  EXPECT_EQ(daemon.state().changes, 0U);

  auto planner = connecting(endpoint);
  planner.tls = tls("planner", true);
  ZenohSession admitted(planner, std::nullopt, {"bole/**"});
  EXPECT_TRUE(time_to_delivery(daemon, admitted));
}

TEST_F(ZenohFiles, RefusesCertificatesThatDoNotFit) {
  make_certificate("ca");
  make_certificate("daemon", "ca");
  make_certificate("other", "ca");
  std::ofstream(path("empty.pem")) << "nothing\n";
  auto config = listening(free_endpoint("tls"));
  const auto refused = [&](const ZenohConfig::Tls& tls) {
    config.tls = tls;
    return config_problem([&] { ZenohSession session(config); });
  };
  auto mixed = tls("daemon", true);
  mixed.private_key = path("other.key");
  EXPECT_THAT(refused(mixed), AllOf(HasSubstr("zenoh.tls.private_key"), HasSubstr("does not fit")));
  mixed.private_key = path("daemon.pem");
  EXPECT_THAT(refused(mixed), HasSubstr("zenoh.tls.private_key"));
  auto missing = tls("missing", false);
  EXPECT_THAT(refused(missing),
              AllOf(HasSubstr("zenoh.tls.certificate"), HasSubstr("missing.pem")));
  auto no_ca = tls("daemon", true);
  no_ca.ca = path("empty.pem");
  EXPECT_THAT(refused(no_ca), HasSubstr("zenoh.tls.ca"));
  no_ca.ca = "";
  EXPECT_THAT(refused(no_ca), HasSubstr("zenoh.tls.ca"));
  EXPECT_THAT(refused({}), HasSubstr("zenoh.tls.certificate"));
}

TEST_F(ZenohFiles, RefusesAPipeThatNobodyMayEverWriteTo) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  ZenohConfig config;
  config.config_file = path("pipe");
  EXPECT_THAT(config_problem([&] { check_zenoh(config); }),
              AllOf(HasSubstr("zenoh.config_file"), HasSubstr("pipe is not a regular file")));
  config = {};
  config.tls.ca = path("pipe");
  EXPECT_THAT(config_problem([&] { check_zenoh(config); }), HasSubstr("zenoh.tls.ca"));
}

TEST_F(ZenohFiles, TypedSettingsWinOverTheFileAndSaySo) {
  const auto endpoint = free_endpoint();
  std::ofstream(path("zenoh.json5")) << "{ mode: 'client', // never used\n"
                                        "  connect: { endpoints: ['"
                                     << endpoint << "'] } }";
  ZenohSession router(listening(endpoint, "router"));
  ASSERT_TRUE(eventually([&] { return router.state().open; }));
  ZenohConfig config;
  config.config_file = path("zenoh.json5");
  {
    ZenohSession as_the_file_says(config);
    EXPECT_TRUE(eventually([&] { return as_the_file_says.state().routers == 1; }));
    EXPECT_TRUE(as_the_file_says.overridden().empty());
  }
  config.mode = "peer";
  ZenohSession session(config);
  EXPECT_TRUE(eventually([&] { return session.state().routers == 1; }));
  EXPECT_THAT(session.overridden(), Contains("zenoh.mode overrides mode of " + config.config_file));

  std::ofstream(path("zenoh.json5")) << "{ mode: }";
  EXPECT_THAT(config_problem([&] { ZenohSession broken(config); }), HasSubstr("zenoh.config_file"));
}

}  // namespace
}  // namespace bole
