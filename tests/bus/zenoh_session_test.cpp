#include "zenoh_sessions.h"

#include <csignal>

namespace bole {
namespace {

using namespace std::chrono_literals;
using namespace test;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

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

}  // namespace
}  // namespace bole

int main(int argc, char** argv) {
  std::signal(SIGPIPE, SIG_IGN);
  testing::InitGoogleMock(&argc, argv);
  return RUN_ALL_TESTS();
}
