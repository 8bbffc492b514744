#include "service/mailbox.h"

#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace bole {
namespace {

TEST(Mailbox, NewestWinsAndTheOldOneComesBack) {
  Mailbox<int> mailbox;
  int value = 1;
  EXPECT_FALSE(mailbox.put(value, WhenFull::overwrite));
  value = 2;
  EXPECT_TRUE(mailbox.put(value, WhenFull::overwrite));
  EXPECT_EQ(value, 1);
  EXPECT_TRUE(mailbox.take(value).has_value());
  EXPECT_EQ(value, 2);
}

TEST(Mailbox, WhatIsThereCanBeTakenAfterClosing) {
  Mailbox<int> mailbox;
  int value = 7;
  mailbox.put(value, WhenFull::overwrite);
  mailbox.close();
  value = 8;
  EXPECT_FALSE(mailbox.put(value, WhenFull::overwrite));
  EXPECT_TRUE(mailbox.take(value).has_value());
  EXPECT_EQ(value, 7);
  EXPECT_FALSE(mailbox.take(value).has_value());
}

TEST(Mailbox, TheLowerSlotIsTakenFirst) {
  Mailbox<int, 2> mailbox;
  int value = 10;
  mailbox.put(value, WhenFull::overwrite, 1);
  value = 20;
  mailbox.put(value, WhenFull::overwrite, 0);
  EXPECT_EQ(mailbox.take(value), 0U);
  EXPECT_EQ(value, 20);
  EXPECT_EQ(mailbox.take(value), 1U);
  EXPECT_EQ(value, 10);
}

TEST(Mailbox, KeepsTheCapacityOfWhatGoesThrough) {
  Mailbox<std::vector<int>> mailbox;
  std::vector<int> in, out;
  const auto round = [&] {
    in.assign(100, 1);
    mailbox.put(in, WhenFull::overwrite);
    mailbox.take(out);
  };
  for (int k = 0; k < 3; ++k) round();
  const std::vector<const int*> before{in.data(), out.data()};
  for (int k = 0; k < 3; ++k) round();
  EXPECT_EQ(in.capacity(), 100U);
  EXPECT_EQ((std::vector<const int*>{in.data(), out.data()}), before);
}

TEST(Mailbox, WaitingLosesNothingBetweenThreads) {
  Mailbox<int> mailbox;
  std::thread producer([&] {
    for (int k = 0; k < 10'000; ++k) {
      int value = k;
      EXPECT_FALSE(mailbox.put(value, WhenFull::wait));
    }
    mailbox.close();
  });
  int expected = 0;
  for (int value; mailbox.take(value); ++expected) ASSERT_EQ(value, expected);
  producer.join();
  EXPECT_EQ(expected, 10'000);
}

TEST(Mailbox, OverwritingCountsExactlyWhatIsLostBetweenThreads) {
  Mailbox<int> mailbox;
  int overwritten = 0;
  std::thread producer([&] {
    for (int k = 1; k <= 10'000; ++k) {
      int value = k;
      if (mailbox.put(value, WhenFull::overwrite)) ++overwritten;
    }
    mailbox.close();
  });
  int taken = 0, last = 0;
  for (int value; mailbox.take(value); ++taken) {
    EXPECT_GT(value, last);
    last = value;
  }
  producer.join();
  EXPECT_EQ(taken + overwritten, 10'000);
  EXPECT_EQ(last, 10'000);
}

TEST(Mailbox, ClosingReleasesAProducerThatWaits) {
  Mailbox<int> mailbox;
  int value = 1;
  mailbox.put(value, WhenFull::wait);
  std::thread producer([&] {
    int second = 2;
    EXPECT_FALSE(mailbox.put(second, WhenFull::wait));
  });
  mailbox.close();
  producer.join();
}

TEST(Mailbox, OneRingWakesTheTakersOfAllMailboxesThatShareTheBell) {
  const auto bell = std::make_shared<Doorbell>();
  Mailbox<int> first(bell), second(bell);
  std::vector<std::thread> takers;
  for (Mailbox<int>* mailbox : {&first, &second}) {
    takers.emplace_back([mailbox] {
      int value = 0;
      EXPECT_TRUE(mailbox->take(value).has_value());
      EXPECT_EQ(value, 5);
    });
  }
  for (Mailbox<int>* mailbox : {&first, &second}) {
    int value = 5;
    EXPECT_FALSE(mailbox->lay(value, WhenFull::overwrite));
  }
  bell->ring();
  for (std::thread& taker : takers) taker.join();
}

}  // namespace
}  // namespace bole
