#include "service/buses.h"

#include <condition_variable>
#include <regex>

#include <gtest/gtest.h>

#include "base/clock.h"
#include "publish/decoder.h"

namespace bole {
namespace {

// What a bus does is up to the test: it may refuse or hold up messages.
struct BusScript {
  std::mutex mutex;
  std::condition_variable changed;
  bool lists_only = false;
  bool held = false;
  std::string refusal;
  std::vector<std::size_t> sizes;  // of the messages that arrived
  std::vector<std::byte> last;     // of them

  void hold(bool now) {
    const std::lock_guard lock(mutex);
    held = now;
    changed.notify_all();
  }
  void refuse(const std::string& reason) {
    const std::lock_guard lock(mutex);
    refusal = reason;
  }
  void wait_for_messages(std::size_t count) {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return sizes.size() >= count; });
  }
};

class ScriptedBus : public Publisher {
 public:
  explicit ScriptedBus(BusScript& script) : script_(script) {}
  std::string name() const override { return "scripted"; }
  bool carries(MessageKind kind) const override {
    return !script_.lists_only || kind == MessageKind::trees;
  }
  void publish(MessageKind /*kind*/, std::span<const std::byte> bytes,
               const std::string& /*file*/) override {
    std::unique_lock lock(script_.mutex);
    script_.sizes.push_back(bytes.size());
    script_.last.assign(bytes.begin(), bytes.end());
    script_.changed.notify_all();
    script_.changed.wait(lock, [&] { return !script_.held; });
    if (!script_.refusal.empty()) throw BusError(script_.refusal);
  }

 private:
  BusScript& script_;
};

void offer(Buses& buses, std::size_t size, MessageKind kind = MessageKind::trees) {
  buses.offer(kind, std::vector<std::byte>(size), "", SystemClock().mono_ns());
}

// One bus for each script.
std::unique_ptr<Buses> buses_of(std::initializer_list<BusScript*> scripts, WhenFull when_full) {
  std::vector<std::unique_ptr<Publisher>> publishers;
  for (BusScript* script : scripts) publishers.push_back(std::make_unique<ScriptedBus>(*script));
  return std::make_unique<Buses>(std::move(publishers), when_full, [] {});
}

TEST(Buses, ASlowBusGetsTheNewestListAndTheOthersAreCounted) {
  BusScript script;
  script.hold(true);
  const auto bus = buses_of({&script}, WhenFull::overwrite);
  offer(*bus, 1);
  script.wait_for_messages(1);  // held in the bus; the slot is free
  for (std::size_t size = 2; size <= 5; ++size) offer(*bus, size);
  script.hold(false);
  script.wait_for_messages(2);
  bus->close();
  while (!bus->finished()) std::this_thread::yield();
  EXPECT_EQ(script.sizes, (std::vector<std::size_t>{1, 5}));
  EXPECT_EQ(bus->health()[0].overwritten, 3);
  EXPECT_EQ(bus->health()[0].published, 2);
}

TEST(Buses, ASlowBusDelaysNoOther) {
  BusScript slow, quick;
  slow.hold(true);
  const auto buses = buses_of({&slow, &quick}, WhenFull::overwrite);
  offer(*buses, 1);
  slow.wait_for_messages(1);
  quick.wait_for_messages(1);
  for (std::size_t size = 2; size <= 5; ++size) {
    offer(*buses, size);
    quick.wait_for_messages(size);
  }
  slow.hold(false);
  buses->close();
  while (!buses->finished()) std::this_thread::yield();
  EXPECT_EQ(slow.sizes, (std::vector<std::size_t>{1, 5}));
  EXPECT_EQ(quick.sizes, (std::vector<std::size_t>{1, 2, 3, 4, 5}));
}

TEST(Buses, InLockstepNothingIsLost) {
  BusScript script;
  const auto bus = buses_of({&script}, WhenFull::wait);
  for (std::size_t size = 0; size < 500; ++size) offer(*bus, size);
  bus->close();
  while (!bus->finished()) std::this_thread::yield();
  EXPECT_EQ(script.sizes.size(), 500U);
  EXPECT_EQ(bus->health()[0].published, 500);
}

TEST(Buses, AStatusDoesNotTakeAListsPlace) {
  BusScript script;
  script.hold(true);
  const auto bus = buses_of({&script}, WhenFull::overwrite);
  offer(*bus, 1);
  script.wait_for_messages(1);
  offer(*bus, 2);
  offer(*bus, 3, MessageKind::status);
  script.hold(false);
  script.wait_for_messages(3);
  EXPECT_EQ(script.sizes, (std::vector<std::size_t>{1, 3, 2}));
  EXPECT_EQ(bus->health()[0].overwritten, 0);
}

TEST(Buses, AStatusTellsTheTimeAndHowTheBusesDo) {
  BusScript script;
  const auto bus = buses_of({&script}, WhenFull::wait);
  const ReplayClock clock(7'000'000);
  bus->offer(status_t{}, clock);
  script.wait_for_messages(1);
  const status_t status = decode_status(script.last);
  EXPECT_EQ(status.mono_ns, 7'000'000);
  EXPECT_EQ(status.utime, 7'000);
  ASSERT_EQ(status.num_buses, 1);
  EXPECT_EQ(status.buses[0].name, "scripted");
}

TEST(Buses, ARefusalIsAStateAndACounterAndEndsWithTheNextSuccess) {
  BusScript script;
  script.refuse("no route");
  const auto bus = buses_of({&script}, WhenFull::wait);
  for (int k = 0; k < 3; ++k) offer(*bus, 1);
  script.wait_for_messages(3);
  while (bus->health()[0].failed < 3) std::this_thread::yield();
  EXPECT_EQ(bus->health()[0].healthy, 0);
  EXPECT_EQ(bus->health()[0].last_error, "no route");
  script.refuse("");
  offer(*bus, 1);
  while (bus->health()[0].published < 1) std::this_thread::yield();
  EXPECT_EQ(bus->health()[0].healthy, 1);
  EXPECT_EQ(bus->health()[0].failed, 3);
}

TEST(Buses, TwoReasonsThatTakeTurnsAreToldOnceEachOutage) {
  testing::internal::CaptureStdout();  // where the log goes in tests
  {
    BusScript script;
    const auto bus = buses_of({&script}, WhenFull::wait);
    const auto fail = [&](int failures, const char* reason) {
      script.refuse(reason);
      offer(*bus, 1);
      while (bus->health()[0].failed < failures) std::this_thread::yield();
    };
    fail(1, "no route");
    fail(2, "no buffers");
    fail(3, "no route");
    script.refuse("");
    offer(*bus, 1);
    while (bus->health()[0].published < 1) std::this_thread::yield();
    fail(4, "no route");
  }
  const std::string log = testing::internal::GetCapturedStdout();
  const std::regex no_route("no route");
  EXPECT_EQ(std::distance(std::sregex_iterator(log.begin(), log.end(), no_route), {}), 2) << log;
}

TEST(Buses, ABusWithoutStatusesIsNotTakenForWellByThem) {
  BusScript script;
  script.lists_only = true;
  script.refuse("disk full");
  const auto bus = buses_of({&script}, WhenFull::wait);
  offer(*bus, 1);
  while (bus->health()[0].failed < 1) std::this_thread::yield();
  offer(*bus, 2, MessageKind::status);
  offer(*bus, 3);
  while (bus->health()[0].failed < 2) std::this_thread::yield();
  EXPECT_EQ(bus->health()[0].healthy, 0);
  EXPECT_EQ(script.sizes, (std::vector<std::size_t>{1, 3}));
}

TEST(Buses, HandOversAreBinnedByPowersOfTwoMicroseconds) {
  BusScript script;
  const auto bus = buses_of({&script}, WhenFull::wait);
  bus->offer(MessageKind::trees, {}, "", SystemClock().mono_ns() - 1'000'000'000);
  bus->offer(MessageKind::trees, {}, "",
             SystemClock().mono_ns() + 1'000'000'000);  // a stepped clock
  while (bus->health()[0].published < 2) std::this_thread::yield();
  EXPECT_EQ(bus->health()[0].handover_histogram[bus_t::HANDOVER_BINS - 1], 1);
  EXPECT_EQ(bus->health()[0].handover_histogram[0], 1);
  EXPECT_GE(bus->health()[0].handover_max_us, 1e6F);
}

}  // namespace
}  // namespace bole
