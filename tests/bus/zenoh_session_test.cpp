// Real sessions on 127.0.0.1, and a Python client as a second opinion.

#include "publish/zenoh_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/errors.h"
#include "base/files.h"

namespace bole {
namespace {

using namespace std::chrono_literals;
using std::chrono::steady_clock;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

const ZenohIdentity identity{.robot = "harvester", .camera = "top"};
const std::string prefix = "bole/harvester/top/";

// A port that nothing listens on; open() sets SO_REUSEADDR, so that it can be taken at once.
UniqueFd bind_to_free_port(int& port) {
  UniqueFd fd(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  EXPECT_EQ(bind(fd.get(), reinterpret_cast<sockaddr*>(&address), size), 0);
  EXPECT_EQ(getsockname(fd.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
  port = ntohs(address.sin_port);
  return fd;
}

std::string free_endpoint(const std::string& protocol = "tcp") {
  int port = 0;
  bind_to_free_port(port);
  return protocol + "/127.0.0.1:" + std::to_string(port);
}

ZenohConfig listening(const std::string& endpoint, const std::string& mode = "peer") {
  ZenohConfig config;
  config.file = "boled.toml";
  config.mode = mode;
  config.listen = {endpoint};
  return config;
}

ZenohConfig connecting(const std::string& endpoint, const std::string& mode = "peer") {
  ZenohConfig config;
  config.file = "boled.toml";
  config.mode = mode;
  config.connect = {endpoint};
  return config;
}

bool eventually(const std::function<bool()>& condition, std::chrono::milliseconds limit = 10s) {
  const auto end = steady_clock::now() + limit;
  while (!condition()) {
    if (steady_clock::now() > end) return false;
    std::this_thread::sleep_for(5ms);
  }
  return true;
}

std::vector<std::byte> bytes_of(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

// Takes messages until one is as wanted.
std::optional<ZenohMessage> await(ZenohSession& session, ZenohMessage::Event event,
                                  const std::string& key, std::chrono::milliseconds limit = 10s) {
  const auto end = steady_clock::now() + limit;
  while (steady_clock::now() < end) {
    for (auto& message : session.receive(50ms)) {
      if (message.event == event && message.key == key) return std::move(message);
    }
  }
  return std::nullopt;
}

// Publishes until the subscriber gets something: how long that took.
std::optional<std::chrono::milliseconds> time_to_delivery(ZenohSession& daemon,
                                                          ZenohSession& subscriber) {
  const auto start = steady_clock::now();
  subscriber.receive(0ms);
  while (steady_clock::now() < start + 10s) {
    daemon.put(ZenohTopic::trees, bytes_of("list"));
    if (await(subscriber, ZenohMessage::Event::sample, prefix + "trees", 100ms)) {
      return std::chrono::duration_cast<std::chrono::milliseconds>(steady_clock::now() - start);
    }
  }
  return std::nullopt;
}

template <typename Call>
std::string error_of(Call call) {
  try {
    call();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(ZenohSession, DeliversTheBytesWithTheirSchema) {
  const auto endpoint = free_endpoint();
  ZenohSession daemon(listening(endpoint), identity);
  ZenohSession subscriber(connecting(endpoint, "client"), std::nullopt, {"bole/**"});
  ASSERT_TRUE(await(subscriber, ZenohMessage::Event::alive, prefix + "alive"));

  std::vector<std::byte> payload(1400);
  for (std::size_t i = 0; i < payload.size(); ++i) payload[i] = static_cast<std::byte>(i);
  EXPECT_TRUE(daemon.put(ZenohTopic::trees, payload));
  const auto message = await(subscriber, ZenohMessage::Event::sample, prefix + "trees");
  ASSERT_TRUE(message);
  EXPECT_EQ(message->payload, payload);
  EXPECT_EQ(message->encoding, "application/octet-stream;bole.tree_list_t");
}

TEST(ZenohSession, TellsTheDaemonsLifeFromItsToken) {
  const auto endpoint = free_endpoint();
  ZenohSession watcher(listening(endpoint), std::nullopt, {"bole/*/*/alive"});
  std::optional<ZenohSession> daemon(std::in_place, connecting(endpoint), identity);
  EXPECT_TRUE(await(watcher, ZenohMessage::Event::alive, prefix + "alive"));
  EXPECT_TRUE(eventually([&] { return daemon->state().peers == 1; }));
  daemon.reset();
  EXPECT_TRUE(await(watcher, ZenohMessage::Event::gone, prefix + "alive"));
  EXPECT_TRUE(eventually([&] { return !watcher.state().connected(); }));
  EXPECT_EQ(watcher.state().changes, 2U);
}

TEST(ZenohSession, PublishesAgainSoonAfterTheRouterComesBack) {
  const auto endpoint = free_endpoint();
  for (const std::string mode : {"peer", "client"}) {
    ZenohSession daemon(connecting(endpoint, mode), identity);
    EXPECT_FALSE(daemon.state().connected());
    ZenohSession subscriber(connecting(endpoint, "client"), std::nullopt, {"bole/**"});
    for (std::uint64_t outage = 0; outage < 3; ++outage) {
      ZenohSession router(listening(endpoint, "router"));
      ASSERT_TRUE(eventually([&] { return router.state().open; }));
      const auto resumed = time_to_delivery(daemon, subscriber);
      ASSERT_TRUE(resumed) << mode << ", outage " << outage;
      EXPECT_LT(*resumed, 3s);
      EXPECT_EQ(daemon.state().routers, 1);
      EXPECT_EQ(daemon.state().changes, 2 * outage + 1);
    }
    EXPECT_TRUE(eventually([&] { return daemon.state().routers == 0; }));
  }
}

TEST(ZenohSession, SaysWhyItDoesNotReachItsRouter) {
  const auto endpoint = free_endpoint();
  ZenohSession::take_warnings();
  ZenohSession peer(connecting(endpoint), identity);
  std::string heard;
  EXPECT_TRUE(eventually([&] {
    for (const auto& warning : ZenohSession::take_warnings()) heard += warning.text + "\n";
    return heard.find(endpoint) != std::string::npos;
  })) << heard;
  EXPECT_THAT(heard, AllOf(HasSubstr("Unable to connect"), HasSubstr("Connection refused"),
                           Not(HasSubstr(".rs:"))));

  ZenohSession client(connecting(endpoint, "client"), identity);
  EXPECT_TRUE(eventually([&] { return !client.state().error.empty(); }));
  EXPECT_THAT(client.state().error, AllOf(HasSubstr(endpoint), Not(HasSubstr(".rs:"))));
  EXPECT_FALSE(client.state().open);
  EXPECT_FALSE(client.put(ZenohTopic::trees, bytes_of("list")));
}

TEST(ZenohSession, ClientTurnsToTheRouterThatAnswers) {
  const auto dead = free_endpoint();
  const auto alive = free_endpoint();
  ZenohSession router(listening(alive, "router"));
  ASSERT_TRUE(eventually([&] { return router.state().open; }));
  auto config = connecting(dead, "client");
  config.connect.push_back(alive);
  ZenohSession client(config);
  EXPECT_TRUE(eventually([&] { return client.state().routers == 1; }));
}

TEST(ZenohSession, IsAClientWhenItOnlyConnects) {
  const auto endpoint = free_endpoint();
  ZenohSession router(listening(endpoint, "router"));
  ZenohSession daemon(connecting(endpoint, ""), identity);
  ZenohSession planner(connecting(endpoint, ""), std::nullopt, {"bole/**"});
  EXPECT_TRUE(time_to_delivery(daemon, planner));  // routers carry nothing from peer to peer
}

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
    EXPECT_THAT(error_of([&] { ZenohSession session(connecting(endpoint)); }), expected);
  }
  EXPECT_THAT(error_of([] { ZenohSession session(listening("tcp/x")); }),
              HasSubstr("zenoh.listen"));
}

TEST(ZenohSession, RefusesAPortInUse) {
  int port = 0;
  const auto taken = bind_to_free_port(port);
  ASSERT_EQ(listen(taken.get(), 1), 0);
  const auto endpoint = "tcp/127.0.0.1:" + std::to_string(port);
  EXPECT_THAT(error_of([&] { ZenohSession session(listening(endpoint)); }),
              AllOf(HasSubstr("zenoh.listen"), HasSubstr("the port is in use")));
}

TEST(ZenohSession, RefusesSettingsThatCannotWork) {
  auto config = listening(free_endpoint());
  config.mode = "broker";
  EXPECT_THAT(error_of([&] { ZenohSession session(config); }), HasSubstr("zenoh.mode"));
  config = {};
  config.mode = "client";
  EXPECT_THAT(error_of([&] { ZenohSession session(config); }), HasSubstr("zenoh.connect"));
  config = listening(free_endpoint());
  config.config_file = "/nonexistent.json5";
  EXPECT_THAT(error_of([&] { ZenohSession session(config); }),
              AllOf(HasSubstr("zenoh.config_file"), HasSubstr("/nonexistent.json5")));
  const auto endpoint = free_endpoint();
  for (const std::string name : {"a*", "a/", ""}) {
    EXPECT_NE(error_of([&] {
                ZenohSession session(listening(endpoint), {{name, "top"}});
              }),
              "")
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
    return error_of([&] { ZenohSession session(config); });
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
  EXPECT_THAT(error_of([&] { ZenohSession broken(config); }), HasSubstr("zenoh.config_file"));
}

// A run of zenoh_client.py.
class PythonClient {
 public:
  explicit PythonClient(const std::string& arguments)
      : pipe_(popen(("exec " BOLE_PYTHON " " BOLE_SOURCE_DIR "/tests/bus/zenoh_client.py " +
                     arguments + " 2>&1")
                        .c_str(),
                    "re")) {}
  PythonClient(const PythonClient&) = delete;
  PythonClient& operator=(const PythonClient&) = delete;
  ~PythonClient() { pclose(pipe_); }

  static bool available() { return std::system(BOLE_PYTHON " -c 'import zenoh' 2>/dev/null") == 0; }

  std::string line() {
    std::string text(8192, '\0');
    if (std::fgets(text.data(), static_cast<int>(text.size()), pipe_) == nullptr) return "";
    return text.substr(0, text.find('\n'));
  }

 private:
  std::FILE* pipe_;
};

class ZenohPython : public testing::Test {
 protected:
  void SetUp() override {
    if (!PythonClient::available()) GTEST_SKIP() << BOLE_PYTHON " has no eclipse-zenoh";
    ASSERT_TRUE(eventually([&] { return daemon_.state().open; }));
  }

  const std::string endpoint_ = free_endpoint();
  ZenohSession daemon_{listening(endpoint_), identity};
};

TEST_F(ZenohPython, SubscriberGetsTheSameBytes) {
  PythonClient client(endpoint_ + " subscribe 'bole/**' 2");
  ASSERT_EQ(client.line(), "ready");
  ASSERT_TRUE(eventually([&] { return daemon_.state().peers == 1; }));
  std::this_thread::sleep_for(200ms);  // until the subscription has come over
  daemon_.put(ZenohTopic::trees, bytes_of("trees"));
  daemon_.put(ZenohTopic::status, bytes_of("status"));
  std::vector<std::string> lines{client.line(), client.line()};
  std::ranges::sort(lines);  // the two have different priorities
  EXPECT_EQ(lines[0], prefix + "status application/octet-stream;bole.status_t 737461747573");
  EXPECT_EQ(lines[1], prefix + "trees application/octet-stream;bole.tree_list_t 7472656573");
}

TEST_F(ZenohPython, QueriesAreAnsweredWithTheLastBytes) {
  const auto answer = [&](const std::string& name) {
    return PythonClient(endpoint_ + " get " + prefix + name).line();
  };
  EXPECT_EQ(answer("trees"), "");
  daemon_.put(ZenohTopic::trees, bytes_of("old"));
  daemon_.put(ZenohTopic::trees, bytes_of("new"));
  daemon_.set_answer(ZenohTopic::config, bytes_of("x = 1"), "application/toml");
  EXPECT_THAT(answer("trees"), HasSubstr(" 6e6577"));
  EXPECT_THAT(answer("config"), AllOf(HasSubstr("application/toml"), HasSubstr(" 78203d2031")));
}

TEST_F(ZenohPython, ASubscriberThatNeverReadsDelaysNothing) {
  PythonClient client(endpoint_ + " ignore 'bole/**'");
  ASSERT_EQ(client.line(), "ready");
  ASSERT_TRUE(eventually([&] { return daemon_.state().peers == 1; }));
  ZenohSession subscriber(connecting(endpoint_, "client"), std::nullopt, {"bole/**"});
  ASSERT_TRUE(time_to_delivery(daemon_, subscriber));

  const std::vector<std::byte> payload(1400);
  std::vector<double> took_us;
  for (int i = 0; i < 3000; ++i) {
    const auto start = steady_clock::now();
    daemon_.put(ZenohTopic::trees, payload);
    took_us.push_back(
        std::chrono::duration<double, std::micro>(steady_clock::now() - start).count());
    std::this_thread::sleep_for(200us);
  }
  std::ranges::sort(took_us);
  RecordProperty("p50_us", std::to_string(took_us[took_us.size() / 2]));
  RecordProperty("p99_us", std::to_string(took_us[took_us.size() * 99 / 100]));
  RecordProperty("max_us", std::to_string(took_us.back()));
  EXPECT_LT(took_us[took_us.size() * 99 / 100], 1000);
  EXPECT_TRUE(time_to_delivery(daemon_, subscriber));
}

}  // namespace
}  // namespace bole

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);
  testing::InitGoogleMock(&argc, argv);
  return RUN_ALL_TESTS();
}
